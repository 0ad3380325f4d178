(** Across a knot that is repeated r times a spline of degree p is C^(p-r), and some are no smoother. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives.
Open Scope R_scope.

(** z = t_(j+1) = .. = t_k, the knots beside it t_j < z < t_(k+1); it is repeated k - j times. *)
Definition repeated (t : nat -> R) (j k : nat) (z : R) : Prop :=
  (j < k)%nat /\ (forall i, (j < i <= k)%nat -> t i = z) /\ t j < z < t (S k).

Section At_a_knot.
Variables (t : nat -> R) (j k : nat) (z : R).
Hypothesis Hz : repeated t j k z.

Lemma from_the_left q : forall i, (q <= k - j)%nat -> cox (delta j) t q i z = delta j i.
Proof.
  destruct Hz as (Hjk & E & H1 & H2). induction q as [|q IH]; intros i Hq; [reflexivity|].
  rewrite cox_step, !IH by lia. unfold delta.
  destruct (Nat.eq_dec i j) as [Ei|], (Nat.eq_dec (S i) j); try lia; try ring.
  - rewrite Ei, (E (j + S q)%nat) by lia. rewrite quo_one by lra. ring.
  - rewrite (E (S i + S q)%nat) by lia. ring.
Qed.

Lemma from_the_right q : forall i, (q <= k - j)%nat -> cox (delta k) t q i z = delta (k - q) i.
Proof.
  destruct Hz as (Hjk & E & H1 & H2). induction q as [|q IH]; intros i Hq; [cbn; now rewrite Nat.sub_0_r|].
  rewrite cox_step, !IH by lia. unfold delta.
  destruct (Nat.eq_dec i (k - q)) as [Ei|], (Nat.eq_dec (S i) (k - q)), (Nat.eq_dec i (k - S q)); try lia; try ring.
  - rewrite (E i) by lia. ring.
  - replace (S i + S q)%nat with (S k) by lia. rewrite (E (S i)) by lia. rewrite quo_one by lra. ring.
Qed.

(** Both polynomials have one value at z, if the degree is as large as the number of times. *)
Lemma functions_meet p : forall i, (k - j <= p)%nat -> cox (delta j) t p i z = cox (delta k) t p i z.
Proof.
  induction p as [|p IH]; intros i Hp.
  - destruct Hz. lia.
  - destruct (Nat.eq_dec (k - j) (S p)) as [E|N].
    + rewrite from_the_left, from_the_right by lia. f_equal. destruct Hz. lia.
    + rewrite !cox_step, !IH by lia. reflexivity.
Qed.

Lemma pieces_meet m p P : (k - j <= p)%nat -> piece j m t p P z = piece k m t p P z.
Proof. intro H. apply sum_ext. intros i _. now rewrite functions_meet. Qed.
End At_a_knot.

(** The neighbourhood of the knot in which nothing but it happens. *)
Definition around (t : nat -> R) (j k : nat) (x : R) : Prop := t j < x < t (S k).

Lemma spline_around t j k z m p P x : ascending t -> repeated t j k z -> around t j k x ->
  spline m t p P x = if Rlt_dec x z then piece j m t p P x else piece k m t p P x.
Proof.
  intros up (Hjk & E & H1 & H2) [Hx1 Hx2]. destruct (Rlt_dec x z) as [L|L].
  - apply spline_piece; [exact up|]. split; [lra|]. rewrite E by lia. exact L.
  - apply spline_piece; [exact up|]. split; [|lra]. rewrite E by lia. lra.
Qed.

(** Two functions that meet with value and slope are one differentiable function. *)
Lemma derivative_of_two (D : R -> Prop) (f g F G F' G' : R -> R) z :
  (forall x, derivable_pt_lim F x (F' x)) -> (forall x, derivable_pt_lim G x (G' x)) -> F z = G z -> F' z = G' z ->
  (forall x, D x -> f x = if Rlt_dec x z then F x else G x) ->
  (forall x, D x -> g x = if Rlt_dec x z then F' x else G' x) -> derivative_on D f g.
Proof.
  intros HF HG E E' Ef Eg x Dx eps He.
  destruct (HF x eps He) as [a Ha]. destruct (HG x eps He) as [b Hb].
  set (c := if Req_EM_T x z then 1 else Rabs (x - z)).
  assert (Hc : 0 < c) by (unfold c; destruct (Req_EM_T x z); [lra|apply Rabs_pos_lt; lra]).
  exists (Rmin (Rmin a b) c). split; [repeat apply Rmin_pos; auto; apply cond_pos|].
  intros y [[Dy Hne] Hy]. cbn in *. unfold R_dist in *.
  pose proof (Rmin_l (Rmin a b) c). pose proof (Rmin_r (Rmin a b) c).
  pose proof (Rmin_l a b). pose proof (Rmin_r a b).
  assert (Hn : y - x <> 0) by lra.
  specialize (Ha (y - x) Hn ltac:(lra)). specialize (Hb (y - x) Hn ltac:(lra)).
  replace (x + (y - x)) with y in * by ring.
  rewrite (Ef x Dx), (Ef y Dy), (Eg x Dx).
  assert (Hyc : x <> z -> Rabs (y - x) < Rabs (x - z)) by (unfold c in *; destruct (Req_EM_T x z); intro; [lra|lra]).
  destruct (Rlt_dec x z) as [Lx|Lx], (Rlt_dec y z) as [Ly|Ly]; auto.
  - exfalso. specialize (Hyc ltac:(lra)). rewrite (Rabs_left (x - z)) in Hyc by lra.
    rewrite Rabs_right in Hyc by lra. lra.
  - destruct (Req_dec x z) as [->|N].
    + rewrite <- E, <- E'. exact Ha.
    + exfalso. specialize (Hyc N). rewrite (Rabs_right (x - z)) in Hyc by lra. rewrite Rabs_left in Hyc by lra. lra.
Qed.

Lemma continuous_of_two (D : R -> Prop) (f F G F' G' : R -> R) z : D z ->
  (forall x, derivable_pt_lim F x (F' x)) -> (forall x, derivable_pt_lim G x (G' x)) -> F z = G z ->
  (forall x, D x -> f x = if Rlt_dec x z then F x else G x) -> limit1_in f D (f z) z.
Proof.
  intros Dz HF HG E Ef eps He.
  assert (CF : continuity_pt F z) by (apply derivable_continuous_pt; exists (F' z); apply HF).
  assert (CG : continuity_pt G z) by (apply derivable_continuous_pt; exists (G' z); apply HG).
  destruct (CF eps He) as (a & Ha & Ka). destruct (CG eps He) as (b & Hb & Kb).
  exists (Rmin a b). split; [now apply Rmin_pos|]. intros y [Dy Hy].
  pose proof (Rmin_l a b). pose proof (Rmin_r a b). cbn in *. unfold R_dist in *.
  rewrite (Ef y Dy), (Ef z Dz). destruct (Rlt_dec z z); [lra|].
  destruct (Req_dec y z) as [->|N].
  - destruct (Rlt_dec z z); [lra|]. rewrite Rminus_diag_eq by reflexivity. now rewrite Rabs_R0.
  - destruct (Rlt_dec y z); [rewrite <- E; apply Ka|apply Kb]; (split; [split; [exact I|lra]|lra]).
Qed.

Lemma repeated_shift t j k z : repeated t (S j) (S k) z -> repeated (shift t) j k z.
Proof.
  intros (H & E & L). split; [lia|split; [|exact L]]. intros i Hi. apply (E (S i)). lia.
Qed.

(** C^(p-r): derivatives of every order n <= p - r exist on both sides at once, and the last is continuous. *)
Theorem smooth_at_a_knot n : forall t j k z m p P, ascending t -> repeated t j k z -> (n + (k - j) <= p)%nat ->
  (p <= j)%nat -> (k <= m)%nat -> exists g, derivatives_on (around t j k) n (spline m t p P) g /\
    limit1_in g (around t j k) (g z) z.
Proof.
  induction n as [|n IH]; intros t j k z m p P up Hz Hp Hj Hk; pose proof Hz as (Hjk & E & Hl & Hr).
  - destruct p as [|q]; [lia|]. destruct m as [|m]; [lia|].
    exists (spline (S m) t (S q) P). split; [now intros ? ?|].
    apply (continuous_of_two _ _ (piece j (S m) t (S q) P) (piece k (S m) t (S q) P)
      (piece (j - 1) m (shift t) q (dpoints t (S q) P)) (piece (k - 1) m (shift t) q (dpoints t (S q) P))).
    + split; lra.
    + intro. apply piece_derivative; [exact up|lia].
    + intro. apply piece_derivative; [exact up|lia].
    + apply (pieces_meet t j k z Hz). lia.
    + intros x Hx. now apply spline_around.
  - destruct p as [|q]; [lia|]. destruct m as [|m]; [lia|]. destruct j as [|j]; [lia|]. destruct k as [|k]; [lia|].
    pose proof (repeated_shift t j k z Hz) as Hs. pose proof (ascending_shift t up) as us.
    destruct (IH (shift t) j k z m q (dpoints t (S q) P) us Hs ltac:(lia) ltac:(lia) ltac:(lia)) as (g & Hg & Hc).
    exists g. split; [|exact Hc]. exists (spline m (shift t) q (dpoints t (S q) P)). split; [|exact Hg].
    apply (derivative_of_two _ _ _ (piece (S j) (S m) t (S q) P) (piece (S k) (S m) t (S q) P)
      (piece (S j - 1) m (shift t) q (dpoints t (S q) P)) (piece (S k - 1) m (shift t) q (dpoints t (S q) P)) z).
    + intro. apply piece_derivative; [exact up|lia].
    + intro. apply piece_derivative; [exact up|lia].
    + apply (pieces_meet t (S j) (S k) z Hz). lia.
    + cbn [Nat.sub]. rewrite !Nat.sub_0_r. apply (pieces_meet (shift t) j k z Hs). lia.
    + intros x Hx. now apply spline_around.
    + intros x Hx. cbn [Nat.sub]. rewrite !Nat.sub_0_r. now apply (spline_around (shift t)).
Qed.

(** The n-th derivative of a piece, as the value of one of less degree. *)
Fixpoint piece_end (n k m : nat) (t : nat -> R) (p : nat) (P : nat -> R) (z : R) : R :=
  match n, p, m with
  | O, _, _ => piece k m t p P z
  | S n', S q, S m' => piece_end n' (k - 1) m' (shift t) q (dpoints t (S q) P) z
  | _, _, _ => 0
  end.

Lemma piece_end_step n k m t q P z :
  piece_end (S n) (S k) (S m) t (S q) P z = piece_end n k m (shift t) q (dpoints t (S q) P) z.
Proof. cbn [piece_end Nat.sub]. now rewrite Nat.sub_0_r. Qed.

(** Every control point of a derivative can be prescribed. *)
Lemma antiderivative_points t p (Q : nat -> R) : (0 < p)%nat ->
  exists P, forall i, t (S i) < t (S i + p)%nat -> dpoints t p P i = Q i.
Proof.
  intro Hp. exists (fun i => sum i (fun l => Q l * (t (S l + p)%nat - t (S l)) / INR p)).
  intros i Hi. unfold dpoints. cbn [sum]. rewrite quo_div by lra. field. split; [apply not_0_INR; lia|lra].
Qed.

Lemma piece_ext k m t p P Q z : (forall i, (k - p <= i <= k)%nat -> P i = Q i) -> piece k m t p P z = piece k m t p Q z.
Proof.
  intro H. apply sum_ext. intros i _. destruct (le_lt_dec (k - p) i), (le_lt_dec i k).
  - now rewrite H by lia.
  - rewrite cox_zero; [ring|]. intros. apply delta_0. lia.
  - rewrite cox_zero; [ring|]. intros. apply delta_0. lia.
  - lia.
Qed.

Lemma piece_end_ext n : forall k m t p P Q z, (p <= k)%nat -> (forall i, (k - p <= i <= k)%nat -> P i = Q i) ->
  piece_end n k m t p P z = piece_end n k m t p Q z.
Proof.
  induction n as [|n IH]; intros k m t p P Q z Hk H; [now apply piece_ext|].
  destruct p as [|q], m as [|m]; try reflexivity. cbn [piece_end]. apply IH; [lia|]. intros i Hi.
  unfold dpoints. now rewrite !H by lia.
Qed.

(** And no smoother: a spline whose derivatives of order p - r + 1 from both sides differ. *)
Theorem no_smoother n : forall t j k z m p, ascending t -> repeated t j k z -> p = (n + (k - j))%nat ->
  (p <= j)%nat -> (k <= m)%nat -> exists P, piece_end (S n) j m t p P z <> piece_end (S n) k m t p P z.
Proof.
  induction n as [|n IH]; intros t j k z m p up Hz Hp Hj Hk; pose proof Hz as (Hjk & E & Hl & Hr);
    (destruct p as [|q]; [lia|]); (destruct m as [|m]; [lia|]); (destruct j as [|j]; [lia|]); (destruct k as [|k]; [lia|]);
    pose proof (repeated_shift t j k z Hz) as Hs; pose proof (ascending_shift t up) as us.
  - destruct (antiderivative_points t (S q) (fun i => if Nat.eq_dec i j then 0 else 1) ltac:(lia)) as (P & HP).
    exists P. rewrite !piece_end_step. cbn [piece_end]. unfold piece.
    assert (L : forall i, cox (delta j) (shift t) q i z = delta j i)
      by (intro; apply (from_the_left (shift t) j k z Hs); lia).
    assert (R : forall i, cox (delta k) (shift t) q i z = delta (k - q) i)
      by (intro; apply (from_the_right (shift t) j k z Hs); lia).
    rewrite (sum_single _ j), (sum_single (S m) (S j)); try lia.
    + rewrite L, R, !HP.
      * replace (k - q)%nat with (S j) by lia. rewrite !delta_1.
        destruct (Nat.eq_dec j j), (Nat.eq_dec (S j) j); try lia. lra.
      * rewrite (E (S (S j))) by lia.
        pose proof (ascending_le t up (S (S k)) (S (S j) + S q) ltac:(lia)). lra.
      * rewrite (E (S j + S q)%nat) by lia. exact Hl.
    + intros i _ Hi. rewrite R, delta_0 by lia. ring.
    + intros i _ Hi. rewrite L, delta_0 by lia. ring.
  - destruct (IH (shift t) j k z m q us Hs ltac:(lia) ltac:(lia) ltac:(lia)) as (Q & HQ).
    destruct (antiderivative_points t (S q) Q ltac:(lia)) as (P & HP). exists P.
    rewrite !piece_end_step, (piece_end_ext (S n) j m (shift t) q _ Q), (piece_end_ext (S n) k m (shift t) q _ Q); [exact HQ|lia| |lia|].
    + intros i Hi. apply HP. pose proof (ascending_le t up (S i) (S k) ltac:(lia)).
      pose proof (ascending_le t up (S (S k)) (S i + S q) ltac:(lia)). rewrite (E (S k)) in * by lia. lra.
    + intros i Hi. apply HP. pose proof (ascending_le t up (S i) (S j) ltac:(lia)).
      pose proof (ascending_le t up (S (S j)) (S i + S q) ltac:(lia)). rewrite (E (S (S j))) in * by lia. lra.
Qed.

(** They are derivatives: the n-th derivative of a piece has that value. *)
Theorem piece_end_is n : forall k m t p P, ascending t -> (n <= p)%nat -> (p <= k <= m)%nat ->
  derivatives_on (fun _ => True) n (piece k m t p P) (piece_end n k m t p P).
Proof.
  induction n as [|n IH]; intros k m t p P up Hn Hk; [now intros ? ?|].
  destruct p as [|q]; [lia|]. destruct m as [|m]; [lia|]. cbn [piece_end].
  exists (piece (k - 1) m (shift t) q (dpoints t (S q) P)). split.
  - apply derivative_of. intro. apply piece_derivative; [exact up|lia].
  - apply IH; [now apply ascending_shift|lia|lia].
Qed.
