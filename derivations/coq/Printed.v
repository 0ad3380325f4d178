(** The printed conditions against what has to hold: exactly when they are right, and refuted by numbers.

    One coordinate of one column j: P_i stands for P_ij, Q_i for R_ij or S_ij; p = k - 1, q = k_r - 1 or k_s - 1;
    u_1, u_2 are the first knots of the blend after the contact, h_1, h_2 those of the base, as distances from it. *)
From Coq Require Import Reals Lra Lia List.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives Independence Contact Mirror.
Import ListNotations.
Open Scope R_scope.

Definition printed_2_1 al p q u1 h1 (P0 P1 Q0 Q1 : R) := P1 = al ^ 2 * u1 * q / (h1 * p) * (Q0 - Q1) + P0.
Definition printed_3_1 al p q u1 h1 (P0 P1 P2 Q0 Q1 Q2 : R) :=
  P2 = al ^ 4 * u1 * q * (q - 1) / (h1 * p * (p - 1)) * (Q0 - 2 * Q1 + Q2) + 2 * P1 - P0.
(** If the scan has lost squares. *)
Definition printed_3_1_squares al p q u1 h1 (P0 P1 P2 Q0 Q1 Q2 : R) :=
  P2 = al ^ 4 * u1 ^ 2 * q * (q - 1) / (h1 ^ 2 * p * (p - 1)) * (Q0 - 2 * Q1 + Q2) + 2 * P1 - P0.
(** What (17) and the first derivatives of the appendix give. *)
Definition printed_17 al p q u1 h1 (P0 P1 Q0 Q1 : R) := p / u1 * (P1 - P0) = al ^ 2 * (q / h1 * (Q1 - Q0)).

Lemma scaled_equal c x y : c <> 0 -> c * x = c * y <-> x = y.
Proof. intro H. split; [intro E; now apply (Rmult_eq_reg_l c)|now intros ->]. Qed.

Lemma square_positive x : x <> 0 -> 0 < x ^ 2.
Proof. intro H. replace (x ^ 2) with (Rsqr x) by (unfold Rsqr; ring). now apply Rsqr_pos_lt. Qed.

Section Start.
Variables (m : nat) (t : nat -> R) (p m' : nat) (w : nat -> R) (q : nat) (al : R) (P Q : nat -> R).
Hypotheses (up : ascending t) (Ct : clamped t p) (up' : ascending w) (Cw : clamped w q).
Hypotheses (Hp : (2 <= p <= m)%nat) (Hq : (2 <= q <= m')%nat) (Ha : al <> 0).
Let u := knot t p.
Let h := knot w q.

(** (2.1) is right. *)
Theorem equation_2_1 : contact 1 (al ^ 2) m t p P m' w q Q <->
  P O = Q O /\ printed_2_1 al (INR p) (INR q) (u 1%nat) (h 1%nat) (P O) (P 1%nat) (Q O) (Q 1%nat).
Proof. apply (condition_2_1 m t p m' w q); auto; lia. Qed.

Let Hu : 0 < u 1%nat /\ 0 < u 2%nat /\ 0 < h 1%nat /\ 0 < h 2%nat.
Proof. repeat split; apply knot_positive; auto. Qed.
Let Hn : 2 <= INR p /\ 2 <= INR q.
Proof. split; apply (le_INR 2); lia. Qed.

Let f := al ^ 4 * u 1%nat * INR q * (INR q - 1) / (h 1%nat * INR p * (INR p - 1)).
Let Hf : f <> 0.
Proof.
  repeat apply Rmult_integral_contrapositive_currified; try apply Rinv_neq_0_compat;
    repeat apply Rmult_integral_contrapositive_currified; lra.
Qed.

Lemma plain_difference_iff g : Q 1%nat = Q O -> contact 1 (al ^ 2) m t p P m' w q Q ->
  P 2%nat = g * f * (Q O - 2 * Q 1%nat + Q 2%nat) + 2 * P 1%nat - P O ->
  contact 2 (al ^ 2) m t p P m' w q Q <-> Q 2%nat = Q 1%nat \/ g * h 2%nat = u 2%nat.
Proof.
  intros E1 H1 H3. rewrite condition_3_1 by (auto; lia). fold u h.
  pose proof (proj1 equation_2_1 H1) as [_ E2]. unfold printed_2_1 in E2. rewrite E1 in E2.
  assert (E : P 1%nat = P O) by lra. rewrite H3, E, E1.
  transitivity (f * (g * (Q 2%nat - Q O)) = f * (u 2%nat / h 2%nat * (Q 2%nat - Q O))).
  - assert (Z : P O + u 2%nat / u 1%nat * (P O - P O) + (al ^ 2) ^ 2 * (u 1%nat * u 2%nat * INR q * (INR q - 1)) /
      (h 1%nat * INR p * (INR p - 1)) * ((Q 2%nat - Q O) / h 2%nat - (Q O - Q O) / h 1%nat)
      = P O + f * (u 2%nat / h 2%nat * (Q 2%nat - Q O))) by (unfold f; field; lra).
    rewrite Z. split; [intros [_ K]; lra|intro K; split; [exact H1|lra]].
  - rewrite scaled_equal by exact Hf. split.
    + intro K. destruct (Req_dec (Q 2%nat) (Q O)) as [Z|Z]; [now left|right].
      assert (G : g = u 2%nat / h 2%nat) by (apply (Rmult_eq_reg_r (Q 2%nat - Q O)); lra).
      rewrite G. field. lra.
    + intros [-> | <-]; field; lra.
Qed.

(** Along the normal, where R_w has no part, (3.1) as printed gives contact of order 2 exactly if h_2 = u_2 or the base
    is not curved there; with squares exactly if h_2 / h_1 = u_2 / u_1 or it is not. *)
Theorem printed_3_1_iff : Q 1%nat = Q O -> contact 1 (al ^ 2) m t p P m' w q Q ->
  printed_3_1 al (INR p) (INR q) (u 1%nat) (h 1%nat) (P O) (P 1%nat) (P 2%nat) (Q O) (Q 1%nat) (Q 2%nat) ->
  contact 2 (al ^ 2) m t p P m' w q Q <-> Q 2%nat = Q 1%nat \/ h 2%nat = u 2%nat.
Proof.
  intros E1 H1 H3. rewrite <- (Rmult_1_l (h 2%nat)). apply plain_difference_iff; auto.
  rewrite H3. unfold f. field. lra.
Qed.

Theorem printed_3_1_squares_iff : Q 1%nat = Q O -> contact 1 (al ^ 2) m t p P m' w q Q ->
  printed_3_1_squares al (INR p) (INR q) (u 1%nat) (h 1%nat) (P O) (P 1%nat) (P 2%nat) (Q O) (Q 1%nat) (Q 2%nat) ->
  contact 2 (al ^ 2) m t p P m' w q Q <-> Q 2%nat = Q 1%nat \/ h 2%nat / h 1%nat = u 2%nat / u 1%nat.
Proof.
  intros E1 H1 H3. rewrite (plain_difference_iff (u 1%nat / h 1%nat)); auto.
  - apply or_iff_compat_l. split; intro K.
    + rewrite <- K. field. lra.
    + transitivity (u 1%nat * (h 2%nat / h 1%nat)); [|rewrite K]; field; lra.
  - rewrite H3. unfold f. field. lra.
Qed.

(** (17) as printed gives (2.1) only where the base stands still. *)
Theorem printed_17_iff : P O = Q O ->
  printed_17 al (INR p) (INR q) (u 1%nat) (h 1%nat) (P O) (P 1%nat) (Q O) (Q 1%nat) ->
  contact 1 (al ^ 2) m t p P m' w q Q <-> Q 1%nat = Q O.
Proof.
  intros E0 H. rewrite equation_2_1. unfold printed_2_1. unfold printed_17 in H.
  assert (E : P 1%nat = Q O + al ^ 2 * u 1%nat * INR q / (h 1%nat * INR p) * (Q 1%nat - Q O)).
  { transitivity (P O + u 1%nat / INR p * (INR p / u 1%nat * (P 1%nat - P O))); [|rewrite H, E0]; field; lra. }
  rewrite E, E0. set (c := al ^ 2 * u 1%nat * INR q / (h 1%nat * INR p)).
  assert (Hc : c <> 0).
  { unfold c. repeat apply Rmult_integral_contrapositive_currified; try apply Rinv_neq_0_compat;
      repeat apply Rmult_integral_contrapositive_currified; lra. }
  split.
  - intros [_ K]. apply (Rmult_eq_reg_l (2 * c)); lra.
  - intros ->. split; ring.
Qed.
End Start.

(** Vectors as lists; the last knot is repeated. *)
Definition vector (l : list R) (i : nat) : R := nth i l (last l 0).
Fixpoint sorted (l : list R) : Prop := match l with a :: (b :: _) as r => a <= b /\ sorted r | _ => True end.

Lemma vector_ascending l : sorted l -> ascending (vector l).
Proof.
  unfold vector. induction l as [|a [|b l] IH]; intros H i.
  - destruct i; cbn; lra.
  - destruct i as [|[|i]]; cbn; lra.
  - destruct H as [H1 H2]. specialize (IH H2). cbn [last]. destruct i as [|i]; [cbn; lra|]. apply (IH i).
Qed.


(** The paper's own setting, k = k_r = 4 and uniform u_i; the base has its first inner knots at 1 and 3. *)
Definition U : nat -> R := vector [0; 0; 0; 0; 1/3; 2/3; 1; 1; 1; 1].
Definition W : nat -> R := vector [0; 0; 0; 0; 1; 3; 4; 4; 4; 4].
(** A base that is curved at the contact, in the coordinate along the normal. *)
Definition curved : nat -> R := fun i => nth i [0; 0; 1] 0.

Lemma U_ascending : ascending U.
Proof. apply vector_ascending. cbn. lra. Qed.
Lemma W_ascending : ascending W.
Proof. apply vector_ascending. cbn. lra. Qed.

Local Ltac clamped_vector := split;
  [intros [|[|[|[|[|i]]]]] Hi; try reflexivity; exfalso; lia | cbn; lra].
Lemma U_clamped : clamped U 3.
Proof. clamped_vector. Qed.
Lemma W_clamped : clamped W 3.
Proof. clamped_vector. Qed.
Lemma U_clamped_end : clamped_end U 3 5.
Proof. clamped_vector. Qed.

Lemma U_knots : knot U 3 1 = 1/3 /\ knot U 3 2 = 2/3.
Proof. unfold knot, U, vector; cbn. lra. Qed.
Lemma W_knots : knot W 3 1 = 1 /\ knot W 3 2 = 3.
Proof. unfold knot, W, vector; cbn. lra. Qed.

(** Whatever alpha is, (1.1), (2.1) and (3.1) can be fulfilled as printed, and contact of order 2 is missed. *)
Theorem printed_3_1_fails al : al <> 0 -> exists P, contact 1 (al ^ 2) 5 U 3 P 5 W 3 curved /\
  printed_3_1 al 3 3 (1/3) 1 (P O) (P 1%nat) (P 2%nat) 0 0 1 /\ ~ contact 2 (al ^ 2) 5 U 3 P 5 W 3 curved.
Proof.
  intro Ha. exists (fun i => nth i [0; 0; al ^ 4 / 3] 0). destruct U_knots as [U1 U2], W_knots as [W1 W2].
  pose proof U_ascending. pose proof W_ascending. pose proof U_clamped. pose proof W_clamped.
  assert (C : contact 1 (al ^ 2) 5 U 3 (fun i => nth i [0; 0; al ^ 4 / 3] 0) 5 W 3 curved).
  { apply equation_2_1; auto; try lia. unfold printed_2_1. cbn. split; lra. }
  assert (E : printed_3_1 al 3 3 (1/3) 1 0 0 (al ^ 4 / 3) 0 0 1) by (unfold printed_3_1; field).
  split; [exact C|split; [exact E|]].
  intro K. apply (printed_3_1_iff 5 U 3 5 W 3 al _ curved) in K; try exact C; auto; try lia.
  - rewrite U2, W2 in K. cbn in K. lra.
  - rewrite U1, W1. replace (INR 3) with 3 by (cbn; ring). exact E.
Qed.

Theorem printed_3_1_squares_fails al : al <> 0 -> exists P, contact 1 (al ^ 2) 5 U 3 P 5 W 3 curved /\
  printed_3_1_squares al 3 3 (1/3) 1 (P O) (P 1%nat) (P 2%nat) 0 0 1 /\ ~ contact 2 (al ^ 2) 5 U 3 P 5 W 3 curved.
Proof.
  intro Ha. exists (fun i => nth i [0; 0; al ^ 4 / 9] 0). destruct U_knots as [U1 U2], W_knots as [W1 W2].
  pose proof U_ascending. pose proof W_ascending. pose proof U_clamped. pose proof W_clamped.
  assert (C : contact 1 (al ^ 2) 5 U 3 (fun i => nth i [0; 0; al ^ 4 / 9] 0) 5 W 3 curved).
  { apply equation_2_1; auto; try lia. unfold printed_2_1. cbn. split; lra. }
  assert (E : printed_3_1_squares al 3 3 (1/3) 1 0 0 (al ^ 4 / 9) 0 0 1) by (unfold printed_3_1_squares; field).
  split; [exact C|split; [exact E|]].
  intro K. apply (printed_3_1_squares_iff 5 U 3 5 W 3 al _ curved) in K; try exact C; auto; try lia.
  - rewrite U1, U2, W1, W2 in K. cbn in K. lra.
  - rewrite U1, W1. replace (INR 3) with 3 by (cbn; ring). exact E.
Qed.

(** As statements that are refuted: "(1.1), (2.1) and (3.1) are enough", for cubics over uniform knots. *)
Corollary printed_3_1_refuted : ~ forall w al P Q, ascending w -> clamped w 3 -> al <> 0 ->
  contact 1 (al ^ 2) 5 U 3 P 5 w 3 Q ->
  printed_3_1 al 3 3 (knot U 3 1) (knot w 3 1) (P O) (P 1%nat) (P 2%nat) (Q O) (Q 1%nat) (Q 2%nat) ->
  contact 2 (al ^ 2) 5 U 3 P 5 w 3 Q.
Proof.
  intro H. destruct (printed_3_1_fails 1 ltac:(lra)) as (P & H1 & H3 & H2). apply H2.
  apply (H W 1 P curved W_ascending W_clamped ltac:(lra) H1). destruct U_knots as [-> _], W_knots as [-> _]. exact H3.
Qed.

Corollary printed_3_1_squares_refuted : ~ forall w al P Q, ascending w -> clamped w 3 -> al <> 0 ->
  contact 1 (al ^ 2) 5 U 3 P 5 w 3 Q ->
  printed_3_1_squares al 3 3 (knot U 3 1) (knot w 3 1) (P O) (P 1%nat) (P 2%nat) (Q O) (Q 1%nat) (Q 2%nat) ->
  contact 2 (al ^ 2) 5 U 3 P 5 w 3 Q.
Proof.
  intro H. destruct (printed_3_1_squares_fails 1 ltac:(lra)) as (P & H1 & H3 & H2). apply H2.
  apply (H W 1 P curved W_ascending W_clamped ltac:(lra) H1). destruct U_knots as [-> _], W_knots as [-> _]. exact H3.
Qed.

(** Nor does any other reparametrisation help: on a base that is ruled along y no p_1, q_1, p_2, q_2 fulfil (15), (16).
    x and z are the coordinates across, R_v = (0, 1, 0) and R_vv = R_wv = 0. *)
Definition G2_with (x1 x2 z1 z2 X1 X2 Z1 Z2 p1 q1 p2 q2 : R) : Prop :=
  X1 = p1 * x1 + q1 * 0 /\ 0 = p1 * 0 + q1 * 1 /\ Z1 = p1 * z1 + q1 * 0 /\
  X2 = p2 * x1 + q2 * 0 + p1 ^ 2 * x2 + 2 * p1 * q1 * 0 + q1 ^ 2 * 0 /\
  0 = p2 * 0 + q2 * 1 + p1 ^ 2 * 0 + 2 * p1 * q1 * 0 + q1 ^ 2 * 0 /\
  Z2 = p2 * z1 + q2 * 0 + p1 ^ 2 * z2 + 2 * p1 * q1 * 0 + q1 ^ 2 * 0.

(** The curvature of the section y = const, from derivatives. *)
Definition curvature x1 x2 z1 z2 := (x1 * z2 - x2 * z1) / sqrt (x1 ^ 2 + z1 ^ 2) ^ 3.

Section Section_of_a_ruled_base.
Variables (al : R) (Px Qx Pz : nat -> R) (x1 x2 z1 z2 X1 X2 Z1 Z2 : R).
Hypothesis Ha : al <> 0.
Hypotheses (Cx : contact 1 (al ^ 2) 5 U 3 Px 5 W 3 Qx) (Cz : contact 1 (al ^ 2) 5 U 3 Pz 5 W 3 curved).
Hypothesis regular : Qx 1%nat <> Qx O.
Hypotheses (D1 : start_derivative 1 5 W 3 Qx x1) (D2 : start_derivative 2 5 W 3 Qx x2).
Hypotheses (D3 : start_derivative 1 5 W 3 curved z1) (D4 : start_derivative 2 5 W 3 curved z2).
Hypotheses (D5 : start_derivative 1 5 U 3 Px X1) (D6 : start_derivative 2 5 U 3 Px X2).
Hypotheses (D7 : start_derivative 1 5 U 3 Pz Z1) (D8 : start_derivative 2 5 U 3 Pz Z2).

Let ends k m t p P y : ascending t -> clamped t p -> (p <= m)%nat -> start_derivative k m t p P y ->
  y = differences k p (knot t p) P.
Proof. intros up C Hm H. apply start_derivative_iff in H; auto. now rewrite H, end_derivatives. Qed.

Lemma values : x1 <> 0 /\ z1 = 0 /\ z2 = 2 /\ X1 = - al ^ 2 * x1 /\ Z1 = 0 /\ Pz O = 0 /\ Pz 1%nat = 0 /\
  Z2 = 27 * Pz 2%nat.
Proof.
  destruct U_knots as [U1 U2], W_knots as [W1 W2].
  apply ends in D1, D2, D3, D4, D5, D6, D7, D8; auto using U_ascending, W_ascending, U_clamped, W_clamped; try lia.
  rewrite first_derivative in D1, D3, D5, D7. rewrite second_derivative in D4, D8.
  rewrite W1 in D1, D3. rewrite W1, W2 in D4. rewrite U1 in D5, D7. rewrite U1, U2 in D8. replace (INR 3) with 3 in * by (cbn; ring). cbn in D3, D4.
  apply equation_2_1 in Cx, Cz; auto using U_ascending, W_ascending, U_clamped, W_clamped; try lia.
  destruct Cx as [Cx0 Cx1], Cz as [Cz0 Cz1]. unfold printed_2_1 in *. rewrite U1, W1 in *. cbn in Cz0, Cz1.
  replace (INR 3) with 3 in * by (cbn; ring). assert (Pz 1%nat = 0) by lra.
  split; [intro Z; apply regular; lra|]. repeat split; try lra.
  rewrite D5, D1, Cx1, Cx0. field.
Qed.

Lemma curvature_scaled c : curvature (- al ^ 2 * x1) X2 0 (c * al ^ 4 * 2) = - c * curvature x1 x2 0 2.
Proof.
  destruct values as (Hx & _). unfold curvature.
  assert (A : 0 < al ^ 2) by now apply square_positive.
  assert (E : sqrt ((- al ^ 2 * x1) ^ 2 + 0 ^ 2) = al ^ 2 * sqrt (x1 ^ 2 + 0 ^ 2)).
  { replace ((- al ^ 2 * x1) ^ 2 + 0 ^ 2) with ((al ^ 2) ^ 2 * (x1 ^ 2 + 0 ^ 2)) by ring.
    rewrite sqrt_mult_alt, sqrt_pow2 by nra. reflexivity. }
  assert (S : sqrt (x1 ^ 2 + 0 ^ 2) <> 0).
  { apply Rgt_not_eq, sqrt_lt_R0. replace (x1 ^ 2 + 0 ^ 2) with (x1 ^ 2) by ring. now apply square_positive. }
  rewrite E. field. split; assumption.
Qed.

(** By (3.1) as printed the section has 9/2 times the curvature that it should have; the sign is that of running back. *)
Theorem printed_3_1_curvature : printed_3_1 al 3 3 (1/3) 1 (Pz O) (Pz 1%nat) (Pz 2%nat) 0 0 1 ->
  curvature X1 X2 Z1 Z2 = - (9/2) * curvature x1 x2 z1 z2 /\
  forall p1 q1 p2 q2, ~ G2_with x1 x2 z1 z2 X1 X2 Z1 Z2 p1 q1 p2 q2.
Proof.
  intro H. destruct values as (Hx & Ez1 & Ez2 & EX1 & EZ1 & E0 & E1 & EZ2).
  assert (E2 : Z2 = 9/2 * al ^ 4 * 2) by (rewrite EZ2, H, E0, E1; field).
  split; [rewrite Ez1, Ez2, EX1, EZ1, E2; apply curvature_scaled|].
  intros p1 q1 p2 q2 (G1 & G2 & G3 & G4 & G5 & G6). assert (P1 : p1 = - al ^ 2).
  { apply (Rmult_eq_reg_r x1); [|exact Hx]. rewrite <- EX1, G1. ring. }
  rewrite P1, Ez1, Ez2, E2 in G6. assert (0 < al ^ 2) by now apply square_positive.
  assert (Q1 : q1 = 0) by lra. rewrite Q1 in *. nra.
Qed.

(** With squares it has 3/2 times that curvature. *)
Theorem printed_3_1_squares_curvature : printed_3_1_squares al 3 3 (1/3) 1 (Pz O) (Pz 1%nat) (Pz 2%nat) 0 0 1 ->
  curvature X1 X2 Z1 Z2 = - (3/2) * curvature x1 x2 z1 z2 /\
  forall p1 q1 p2 q2, ~ G2_with x1 x2 z1 z2 X1 X2 Z1 Z2 p1 q1 p2 q2.
Proof.
  intro H. destruct values as (Hx & Ez1 & Ez2 & EX1 & EZ1 & E0 & E1 & EZ2).
  assert (E2 : Z2 = 3/2 * al ^ 4 * 2) by (rewrite EZ2, H, E0, E1; field).
  split; [rewrite Ez1, Ez2, EX1, EZ1, E2; apply curvature_scaled|].
  intros p1 q1 p2 q2 (G1 & G2 & G3 & G4 & G5 & G6). assert (P1 : p1 = - al ^ 2).
  { apply (Rmult_eq_reg_r x1); [|exact Hx]. rewrite <- EX1, G1. ring. }
  rewrite P1, Ez1, Ez2, E2 in G6. assert (0 < al ^ 2) by now apply square_positive.
  assert (Q1 : q1 = 0) by lra. rewrite Q1 in *. nra.
Qed.
End Section_of_a_ruled_base.

(** The hypotheses of that section can be fulfilled, whatever alpha is, in both readings. *)
Definition linear : nat -> R := fun i => nth i [0; 1; 4] 0.
Definition ruled_base (al : R) (row_2 : (nat -> R) -> Prop) := exists Px Pz x1 x2 z1 z2 X1 X2 Z1 Z2,
  contact 1 (al ^ 2) 5 U 3 Px 5 W 3 linear /\ contact 1 (al ^ 2) 5 U 3 Pz 5 W 3 curved /\ linear 1%nat <> linear O /\
  start_derivative 1 5 W 3 linear x1 /\ start_derivative 2 5 W 3 linear x2 /\
  start_derivative 1 5 W 3 curved z1 /\ start_derivative 2 5 W 3 curved z2 /\
  start_derivative 1 5 U 3 Px X1 /\ start_derivative 2 5 U 3 Px X2 /\
  start_derivative 1 5 U 3 Pz Z1 /\ start_derivative 2 5 U 3 Pz Z2 /\ row_2 Pz.

Lemma ruled_base_by al Pz (row_2 : (nat -> R) -> Prop) : contact 1 (al ^ 2) 5 U 3 Pz 5 W 3 curved -> row_2 Pz ->
  ruled_base al row_2.
Proof.
  intros C E. exists (fun i => nth i [0; - al ^ 2 / 3] 0), Pz. do 8 eexists.
  repeat apply conj; [| exact C | cbn; lra | | | | | | | | | exact E];
    try (apply start_derivative_is; auto using U_ascending, W_ascending, U_clamped, W_clamped; lia).
  apply equation_2_1; auto using U_ascending, W_ascending, U_clamped, W_clamped; try lia.
  destruct U_knots as [-> _], W_knots as [-> _]. unfold printed_2_1. cbn. split; field.
Qed.

Theorem a_ruled_base_exists al : al <> 0 ->
  ruled_base al (fun P => printed_3_1 al 3 3 (1/3) 1 (P O) (P 1%nat) (P 2%nat) 0 0 1) /\
  ruled_base al (fun P => printed_3_1_squares al 3 3 (1/3) 1 (P O) (P 1%nat) (P 2%nat) 0 0 1).
Proof.
  intro Ha. split; [destruct (printed_3_1_fails al Ha) as (P & C & E & _)
    | destruct (printed_3_1_squares_fails al Ha) as (P & C & E & _)]; exact (ruled_base_by al P _ C E).
Qed.

(** The other end: (3.2) as printed is (3.1) as printed of the mirrored blend, its knot the last inner one. *)
Theorem printed_3_2_iff m t p m' w q be P Q : ascending t -> clamped_end t p m -> ascending w -> clamped w q ->
  (2 <= p <= m)%nat -> (2 <= q <= m')%nat -> be <> 0 -> Q 1%nat = Q O -> end_contact 1 (be ^ 2) m t p P m' w q Q ->
  printed_3_1 be (INR p) (INR q) (last_knot t m 1) (knot w q 1) (P m) (P (m - 1)%nat) (P (m - 2)%nat)
    (Q O) (Q 1%nat) (Q 2%nat) ->
  end_contact 2 (be ^ 2) m t p P m' w q Q <-> Q 2%nat = Q 1%nat \/ knot w q 2 = last_knot t m 2.
Proof.
  intros up E up' Cw Hp Hq Hb E1 H1 H3. rewrite end_contact_iff in * by (auto; lia).
  rewrite (printed_3_1_iff m (mirror (m + S p) t) p m' w q be (back m P)), knot_mirror;
    auto using mirror_ascending, mirror_clamped; [reflexivity|].
  rewrite knot_mirror. unfold back. rewrite Nat.sub_0_r. exact H3.
Qed.

Theorem printed_3_2_squares_iff m t p m' w q be P Q : ascending t -> clamped_end t p m -> ascending w -> clamped w q ->
  (2 <= p <= m)%nat -> (2 <= q <= m')%nat -> be <> 0 -> Q 1%nat = Q O -> end_contact 1 (be ^ 2) m t p P m' w q Q ->
  printed_3_1_squares be (INR p) (INR q) (last_knot t m 1) (knot w q 1) (P m) (P (m - 1)%nat) (P (m - 2)%nat)
    (Q O) (Q 1%nat) (Q 2%nat) ->
  end_contact 2 (be ^ 2) m t p P m' w q Q <->
    Q 2%nat = Q 1%nat \/ knot w q 2 / knot w q 1 = last_knot t m 2 / last_knot t m 1.
Proof.
  intros up E up' Cw Hp Hq Hb E1 H1 H3. rewrite end_contact_iff in * by (auto; lia).
  rewrite (printed_3_1_squares_iff m (mirror (m + S p) t) p m' w q be (back m P)), !knot_mirror;
    auto using mirror_ascending, mirror_clamped; [reflexivity|].
  rewrite knot_mirror. unfold back. rewrite Nat.sub_0_r. exact H3.
Qed.

Lemma U_last_knots : last_knot U 5 1 = 1/3 /\ last_knot U 5 2 = 2/3.
Proof. unfold last_knot, U, vector; cbn. lra. Qed.

(** Rows 5, 4, 3 of a blend. *)
Definition last_rows (a b c : R) : nat -> R := fun i => nth i [0; 0; 0; c; b; a] 0.

Lemma end_contact_of_rows be c : be <> 0 -> end_contact 1 (be ^ 2) 5 U 3 (last_rows 0 0 c) 5 W 3 curved.
Proof.
  intro Hb. apply condition_2_2; auto using U_ascending, W_ascending, U_clamped_end, W_clamped; try lia.
  destruct U_last_knots as [-> _], W_knots as [-> _]. cbn. split; field.
Qed.

Theorem printed_3_2_fails be : be <> 0 -> exists P, end_contact 1 (be ^ 2) 5 U 3 P 5 W 3 curved /\
  printed_3_1 be 3 3 (1/3) 1 (P 5%nat) (P 4%nat) (P 3%nat) 0 0 1 /\
  ~ end_contact 2 (be ^ 2) 5 U 3 P 5 W 3 curved.
Proof.
  intro Hb. exists (last_rows 0 0 (be ^ 4 / 3)). pose proof (end_contact_of_rows be (be ^ 4 / 3) Hb) as C.
  assert (E : printed_3_1 be 3 3 (1/3) 1 0 0 (be ^ 4 / 3) 0 0 1) by (unfold printed_3_1; field).
  split; [exact C|split; [exact E|]]. intro K. destruct U_last_knots as [U1 U2], W_knots as [W1 W2].
  apply (printed_3_2_iff 5 U 3 5 W 3 be _ curved) in K; try exact C;
    auto using U_ascending, W_ascending, U_clamped_end, W_clamped; try lia.
  - rewrite U2, W2 in K. cbn in K. lra.
  - rewrite U1, W1. replace (INR 3) with 3 by (cbn; ring). exact E.
Qed.

Theorem printed_3_2_squares_fails be : be <> 0 -> exists P, end_contact 1 (be ^ 2) 5 U 3 P 5 W 3 curved /\
  printed_3_1_squares be 3 3 (1/3) 1 (P 5%nat) (P 4%nat) (P 3%nat) 0 0 1 /\
  ~ end_contact 2 (be ^ 2) 5 U 3 P 5 W 3 curved.
Proof.
  intro Hb. exists (last_rows 0 0 (be ^ 4 / 9)). pose proof (end_contact_of_rows be (be ^ 4 / 9) Hb) as C.
  assert (E : printed_3_1_squares be 3 3 (1/3) 1 0 0 (be ^ 4 / 9) 0 0 1) by (unfold printed_3_1_squares; field).
  split; [exact C|split; [exact E|]]. intro K. destruct U_last_knots as [U1 U2], W_knots as [W1 W2].
  apply (printed_3_2_squares_iff 5 U 3 5 W 3 be _ curved) in K; try exact C;
    auto using U_ascending, W_ascending, U_clamped_end, W_clamped; try lia.
  - rewrite U1, U2, W1, W2 in K. cbn in K. lra.
  - rewrite U1, W1. replace (INR 3) with 3 by (cbn; ring). exact E.
Qed.

Corollary printed_3_2_refuted : ~ forall w be P Q, ascending w -> clamped w 3 -> be <> 0 ->
  end_contact 1 (be ^ 2) 5 U 3 P 5 w 3 Q ->
  printed_3_1 be 3 3 (last_knot U 5 1) (knot w 3 1) (P 5%nat) (P 4%nat) (P 3%nat) (Q O) (Q 1%nat) (Q 2%nat) ->
  end_contact 2 (be ^ 2) 5 U 3 P 5 w 3 Q.
Proof.
  intro H. destruct (printed_3_2_fails 1 ltac:(lra)) as (P & H1 & H3 & H2). apply H2.
  apply (H W 1 P curved W_ascending W_clamped ltac:(lra) H1). destruct U_last_knots as [-> _], W_knots as [-> _]. exact H3.
Qed.

Corollary printed_3_2_squares_refuted : ~ forall w be P Q, ascending w -> clamped w 3 -> be <> 0 ->
  end_contact 1 (be ^ 2) 5 U 3 P 5 w 3 Q ->
  printed_3_1_squares be 3 3 (last_knot U 5 1) (knot w 3 1) (P 5%nat) (P 4%nat) (P 3%nat) (Q O) (Q 1%nat) (Q 2%nat) ->
  end_contact 2 (be ^ 2) 5 U 3 P 5 w 3 Q.
Proof.
  intro H. destruct (printed_3_2_squares_fails 1 ltac:(lra)) as (P & H1 & H3 & H2). apply H2.
  apply (H W 1 P curved W_ascending W_clamped ltac:(lra) H1). destruct U_last_knots as [-> _], W_knots as [-> _]. exact H3.
Qed.

(** (17): with p_1 = + alpha^2 a blend of any base that moves away from the contact folds back. *)
Corollary printed_17_refuted : ~ forall w al P Q, ascending w -> clamped w 3 -> al <> 0 -> P O = Q O ->
  printed_17 al 3 3 (knot U 3 1) (knot w 3 1) (P O) (P 1%nat) (Q O) (Q 1%nat) -> contact 1 (al ^ 2) 5 U 3 P 5 w 3 Q.
Proof.
  intro H. set (P := fun i => nth i [0; 1/3] 0).
  assert (E : printed_17 1 3 3 (knot U 3 1) (knot W 3 1) (P O) (P 1%nat) (linear O) (linear 1%nat)).
  { destruct U_knots as [-> _], W_knots as [-> _]. unfold printed_17. cbn. field. }
  specialize (H W 1 P linear W_ascending W_clamped ltac:(lra) eq_refl E).
  apply (printed_17_iff 5 U 3 5 W 3 1) in H; auto using U_ascending, W_ascending, U_clamped, W_clamped; try lia; try lra.
  - cbn in H. lra.
  - replace (INR 3) with 3 by (cbn; ring). exact E.
Qed.

(** (2.2) counts its knot from the wrong end: u_i is the i-th knot after the k zeros, and u_(m-3) the last inner one for
    k = 4 alone. *)
Definition printed_2_2 be m t p q h1 (P1 P0 Q0 Q1 : R) :=
  P1 = be ^ 2 * (t (S m) - t (p + (m - 3))%nat) * q / (h1 * INR p) * (Q0 - Q1) + P0.

Theorem printed_2_2_cubic m t m' w q be P Q : ascending t -> clamped_end t 3 m -> ascending w -> clamped w q ->
  (3 <= m)%nat -> (1 <= q <= m')%nat -> end_contact 1 (be ^ 2) m t 3 P m' w q Q <->
  P m = Q O /\ printed_2_2 be m t 3 (INR q) (knot w q 1) (P (m - 1)%nat) (P m) (Q O) (Q 1%nat).
Proof.
  intros up E up' Cw Hm Hq. rewrite condition_2_2 by (auto; lia). unfold printed_2_2, last_knot.
  replace (3 + (m - 3))%nat with m by lia. replace (S m - 1)%nat with m by lia. reflexivity.
Qed.

Definition U_quartic : nat -> R := vector [0; 0; 0; 0; 0; 1/3; 2/3; 1; 1; 1; 1; 1].

Theorem printed_2_2_refuted : ~ forall w be P Q, ascending w -> clamped w 3 -> be <> 0 -> P 6%nat = Q O ->
  printed_2_2 be 6 U_quartic 4 3 (knot w 3 1) (P 5%nat) (P 6%nat) (Q O) (Q 1%nat) ->
  end_contact 1 (be ^ 2) 6 U_quartic 4 P 5 w 3 Q.
Proof.
  intro H. specialize (H W 1 (fun _ => 0) linear W_ascending W_clamped ltac:(lra) eq_refl).
  assert (up : ascending U_quartic) by (apply vector_ascending; cbn; lra).
  assert (E : clamped_end U_quartic 4 6) by
    (split; [intros [|[|[|[|[|[|i]]]]]] Hi; try reflexivity; exfalso; lia | cbn; lra]).
  rewrite condition_2_2 in H by (auto using W_ascending, W_clamped; lia).
  destruct H as [_ H]; [unfold printed_2_2; cbn; field|].
  - unfold knot, W, vector. cbn. lra.
  - unfold last_knot, knot, U_quartic, W, vector in H. cbn in H. lra.
Qed.

(** The second derivative of the appendix, a plain second difference over one span, without and with a square. *)
Theorem printed_d2_refuted : ~ forall P y, start_derivative 2 5 U 3 P y ->
  y = 3 * 2 / knot U 3 1 * (P 2%nat - 2 * P 1%nat + P O).
Proof.
  intro H. specialize (H curved _ (start_derivative_is 2 5 U 3 curved U_ascending U_clamped ltac:(lia))).
  rewrite end_derivatives, second_derivative in H by (auto using U_ascending, U_clamped).
  destruct U_knots as [U1 U2]. rewrite U1, U2 in H. cbn in H. lra.
Qed.

Theorem printed_d2_squares_refuted : ~ forall P y, start_derivative 2 5 U 3 P y ->
  y = 3 * 2 / knot U 3 1 ^ 2 * (P 2%nat - 2 * P 1%nat + P O).
Proof.
  intro H. specialize (H curved _ (start_derivative_is 2 5 U 3 curved U_ascending U_clamped ltac:(lia))).
  rewrite end_derivatives, second_derivative in H by (auto using U_ascending, U_clamped).
  destruct U_knots as [U1 U2]. rewrite U1, U2 in H. cbn in H. lra.
Qed.
