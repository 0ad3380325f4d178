(** Derivatives of every order at a clamped end, and the rows of control points that prescribed ones make. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives.
Open Scope R_scope.

(** p + 1 equal knots at the start, and no more. *)
Definition clamped (t : nat -> R) (p : nat) : Prop := (forall i, (i <= p)%nat -> t i = t p) /\ t p < t (S p).

(** The k-th derivative at the start, from the right, is y. *)
Definition start_derivative (k m : nat) (t : nat -> R) (p : nat) (P : nat -> R) (y : R) : Prop :=
  exists g, derivatives_on (span t p) k (spline m t p P) g /\ g (t p) = y.

(** u_j, the distance of the j-th knot after the end from it. *)
Definition knot (t : nat -> R) (p j : nat) : R := t (p + j)%nat - t p.

(** The k-th derivative at the start by k times the control points of a derivative. *)
Fixpoint dend (k : nat) (t : nat -> R) (p : nat) (P : nat -> R) : R :=
  match k, p with
  | O, _ => P O
  | S _, O => 0
  | S j, S q => dend j (shift t) q (dpoints t (S q) P)
  end.

Lemma ascending_shift t : ascending t -> ascending (shift t).
Proof. intros H i. apply H. Qed.

Lemma clamped_shift t q : clamped t (S q) -> clamped (shift t) q.
Proof. intros [E H]. split; [intros i Hi; apply (E (S i)); lia|exact H]. Qed.

Lemma start_in_span t p : clamped t p -> span t p (t p).
Proof. intros [_ H]. split; [lra|exact H]. Qed.

(** At the start the first function is one and the others vanish. *)
Lemma start_functions t p : ascending t -> clamped t p -> forall q i, (q <= p)%nat -> (p - q <= i)%nat ->
  cox (delta p) t q i (t p) = if Nat.eq_dec i (p - q) then 1 else 0.
Proof.
  intros up [E H] q. induction q as [|q IH]; intros i Hq Hi.
  - cbn. unfold delta. rewrite Nat.sub_0_r. reflexivity.
  - rewrite cox_step, (IH (S i)) by lia.
    assert (F : (t p - t i) * quo 1 (t (i + S q)%nat - t i) * cox (delta p) t q i (t p) = 0).
    { destruct (Nat.eq_dec i (p - S q)) as [->|Hn]; [rewrite (E (p - S q)%nat) by lia; ring|].
      rewrite IH by lia. destruct (Nat.eq_dec i (p - q)) as [->|]; [rewrite (E (p - q)%nat) by lia|]; ring. }
    rewrite F. destruct (Nat.eq_dec (S i) (p - q)), (Nat.eq_dec i (p - S q)); try lia; try ring.
    replace (S i + S q)%nat with (S p) by lia. rewrite (E (S i)) by lia. rewrite quo_one; lra.
Qed.

Theorem start_value m t p P : ascending t -> clamped t p -> spline m t p P (t p) = P O.
Proof.
  intros up C. rewrite (spline_piece t p) by (auto using start_in_span). unfold piece.
  rewrite (sum_single _ O); [|lia|]; intros; rewrite (start_functions t p up C) by lia;
    destruct Nat.eq_dec; lia || ring.
Qed.

Lemma derivative_zero (D : R -> Prop) : derivative_on D (fun _ => 0) (fun _ => 0).
Proof. apply derivative_of. intro x. exact (derivable_pt_lim_const 0 x). Qed.

Lemma derivatives_zero (D : R -> Prop) k : derivatives_on D k (fun _ => 0) (fun _ => 0).
Proof. induction k as [|k IH]; [now intros ? ?|]. exists (fun _ => 0). split; [apply derivative_zero|exact IH]. Qed.

(** The derivative of every order; those above the degree vanish. *)
Theorem start_derivative_is k : forall m t p P, ascending t -> clamped t p -> (p <= m)%nat ->
  start_derivative k m t p P (dend k t p P).
Proof.
  induction k as [|k IH]; intros m t p P up C Hm; [|destruct p as [|q]].
  - exists (spline m t p P). split; [now intros ? ?|now apply start_value].
  - exists (fun _ => 0). split; [|reflexivity]. exists (fun _ => 0). split; [|apply derivatives_zero].
    apply (derivative_ext _ (piece 0 m t 0 P) _ (fun _ => 0)).
    + intros x Hx. symmetry. now apply spline_piece.
    + reflexivity.
    + apply derivative_of. intro x. apply piece_derivative_0.
  - destruct m as [|m]; [lia|].
    destruct (IH m (shift t) q (dpoints t (S q) P)) as (g & Hg & Hy);
      [now apply ascending_shift|now apply clamped_shift|lia|].
    exists g. split; [|exact Hy]. exists (spline m (shift t) q (dpoints t (S q) P)). split; [|exact Hg].
    apply spline_derivative; [exact up|lia].
Qed.

Theorem start_derivative_iff k m t p P y : ascending t -> clamped t p -> (p <= m)%nat ->
  start_derivative k m t p P y <-> y = dend k t p P.
Proof.
  intros up C Hm. pose proof (start_derivative_is k m t p P up C Hm) as H. split.
  - intros (g & Hg & <-). destruct H as (h & Hh & <-).
    apply (derivatives_unique (span t p) k (dense_span t p) _ g h Hg Hh), start_in_span, C.
  - now intros ->.
Qed.

(** The same by nothing but u_1, u_2, .. and the control points. *)
Fixpoint differences (k p : nat) (u P : nat -> R) : R :=
  match k, p with
  | O, _ => P O
  | S _, O => 0
  | S j, S q => differences j q u (fun i => INR (S q) * (P (S i) - P i) / u (S i))
  end.

Lemma differences_ext k : forall p u P Q, (forall i, (i <= p)%nat -> P i = Q i) ->
  differences k p u P = differences k p u Q.
Proof.
  induction k as [|k IH]; intros p u P Q H; cbn [differences]; [apply H; lia|].
  destruct p as [|q]; [reflexivity|]. apply IH. intros i Hi. now rewrite !H by lia.
Qed.

Lemma clamped_width t q i : ascending t -> clamped t (S q) -> (i <= q)%nat ->
  t (S i + S q)%nat - t (S i) = knot t (S q) (S i) /\ 0 < knot t (S q) (S i).
Proof.
  intros up [E H] Hi. unfold knot. rewrite (E (S i)) by lia. rewrite (Nat.add_comm (S q)).
  split; [reflexivity|]. pose proof (ascending_le t up (S (S q)) (S i + S q) ltac:(lia)). lra.
Qed.

Lemma dpoints_knot t q P i : ascending t -> clamped t (S q) -> (i <= q)%nat ->
  dpoints t (S q) P i = INR (S q) * (P (S i) - P i) / knot t (S q) (S i).
Proof.
  intros up C Hi. destruct (clamped_width t q i up C Hi) as [E H]. unfold dpoints. rewrite E, quo_div; lra.
Qed.

Theorem end_derivatives k : forall t p P, ascending t -> clamped t p -> dend k t p P = differences k p (knot t p) P.
Proof.
  induction k as [|k IH]; intros t p P up C; [reflexivity|]. destruct p as [|q]; [reflexivity|]. cbn [dend differences].
  rewrite IH by (now apply ascending_shift || now apply clamped_shift).
  change (knot (shift t) q) with (knot t (S q)). apply differences_ext.
  intros i Hi. now apply dpoints_knot.
Qed.

(** The first and the second one written out, for every degree: [app-d1], and what [app-d2] should be. *)
Corollary first_derivative p u P : differences 1 p u P = INR p / u 1%nat * (P 1%nat - P O).
Proof. destruct p as [|p]; cbn [differences]; [cbn [INR]|]; unfold Rdiv; ring. Qed.

Corollary second_derivative p u P : differences 2 p u P =
  INR p * (INR p - 1) / u 1%nat * ((P 2%nat - P 1%nat) / u 2%nat - (P 1%nat - P O) / u 1%nat).
Proof.
  destruct p as [|[|p]]; cbn [differences]; [cbn; unfold Rdiv; ring..|]. rewrite (S_INR (S p)). unfold Rdiv. ring.
Qed.

(** e_k(u_1, .., u_i), the elementary symmetric polynomial. *)
Fixpoint esym (u : nat -> R) (i k : nat) : R :=
  match i, k with
  | O, O => 1
  | O, S _ => 0
  | S j, O => esym u j O
  | S j, S l => esym u j (S l) + u (S j) * esym u j l
  end.

Definition weight (t : nat -> R) (p i k : nat) : R := INR (fact (p - k)) / INR (fact p) * esym (knot t p) i k.

Lemma esym_above u i : forall k, (i < k)%nat -> esym u i k = 0.
Proof. induction i as [|i IH]; intros [|k] H; cbn; try lia; try reflexivity. rewrite !IH by lia. ring. Qed.

Lemma esym_diagonal u i : (forall j, (0 < j <= i)%nat -> u j <> 0) -> esym u i i <> 0.
Proof.
  induction i as [|i IH]; intro H; cbn; [lra|]. rewrite esym_above, Rplus_0_l by lia.
  apply Rmult_integral_contrapositive_currified; [apply H|apply IH; intros; apply H]; lia.
Qed.

Lemma fact_positive n : 0 < INR (fact n).
Proof. apply lt_0_INR, lt_O_fact. Qed.

(** Row i of control points, i <= p: P_i = sum over k <= i of (p-k)!/p! e_k(u_1 .. u_i) times the k-th derivative. *)
Theorem rows i : forall t p P, ascending t -> clamped t p -> (i <= p)%nat ->
  P i = sum (S i) (fun k => weight t p i k * dend k t p P).
Proof.
  induction i as [|i IH]; intros t p P up C Hi.
  - cbn. unfold weight. cbn. rewrite Nat.sub_0_r. field. apply Rgt_not_eq, fact_positive.
  - destruct p as [|q]; [lia|]. set (u := knot t (S q)). set (D k := dend k t (S q) P).
    destruct (clamped_width t q i up C ltac:(lia)) as [_ Hu]. fold u in Hu.
    pose proof (dpoints_knot t q P i up C ltac:(lia)) as EQ. fold u in EQ.
    pose proof (IH (shift t) q (dpoints t (S q) P) (ascending_shift t up) (clamped_shift t q C) ltac:(lia)) as HQ.
    pose proof (IH t (S q) P up C ltac:(lia)) as HP.
    assert (Step : P (S i) = P i + u (S i) / INR (S q) * dpoints t (S q) P i).
    { rewrite EQ. field. split; [apply Rgt_not_eq, Hu|]. now apply not_0_INR. }
    rewrite Step, HP, HQ, <- sum_scale.
    transitivity (sum (S (S i)) (fun k => INR (fact (S q - k)) / INR (fact (S q)) * esym u i k * D k)
      + sum (S (S i)) (fun k => match k with O => 0 | S l =>
          INR (fact (S q - k)) / INR (fact (S q)) * (u (S i) * esym u i l) * D k end)).
    + f_equal.
      * cbn [sum]. rewrite (esym_above u i (S i)) by lia. unfold D, weight. fold u. ring.
      * rewrite (sum_first (S i)), Rplus_0_l. apply sum_ext. intros k Hk. unfold weight, D. cbn [dend].
        change (knot (shift t) q) with u. cbn [Nat.sub].
        rewrite fact_simpl, mult_INR. field.
        split; [apply Rgt_not_eq, fact_positive|now apply not_0_INR].
    + rewrite <- sum_add. apply sum_ext. intros [|k] _; unfold D, weight; fold u; cbn [esym]; ring.
Qed.

Lemma weight_diagonal t p k : ascending t -> clamped t p -> (k <= p)%nat -> weight t p k k <> 0.
Proof.
  intros up [_ H] Hk. unfold weight. apply Rmult_integral_contrapositive_currified.
  - apply Rgt_not_eq, Rmult_lt_0_compat; [|apply Rinv_0_lt_compat]; apply fact_positive.
  - apply esym_diagonal. intros j Hj. unfold knot.
    pose proof (ascending_le t up (S p) (p + j) ltac:(lia)). lra.
Qed.

(** Prescribed derivatives up to order n <= p and rows 0 .. n determine each other. *)
Theorem rows_iff n t p P (d : nat -> R) : ascending t -> clamped t p -> (n <= p)%nat ->
  (forall k, (k <= n)%nat -> dend k t p P = d k) <->
  (forall i, (i <= n)%nat -> P i = sum (S i) (fun k => weight t p i k * d k)).
Proof.
  intros up C Hn. split; intro H.
  - intros i Hi. rewrite (rows i t p P up C) by lia. apply sum_ext. intros k Hk. now rewrite H by lia.
  - intro k. induction k as [k IH] using lt_wf_ind. intro Hk.
    pose proof (H k Hk) as E. rewrite (rows k t p P up C) in E by lia. cbn [sum] in E.
    rewrite (sum_ext k _ (fun j => weight t p k j * d j)) in E by (intros j Hj; now rewrite IH by lia).
    apply (Rmult_eq_reg_l (weight t p k k)); [lra|]. apply weight_diagonal; auto; lia.
Qed.
