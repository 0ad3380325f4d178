(** The derivative of a B-spline, for every degree; derivatives of a curve are limits, from the right at the knot where
    a span begins. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines.
Open Scope R_scope.

Lemma derivable_ext f g x l : (forall y, f y = g y) -> derivable_pt_lim f x l -> derivable_pt_lim g x l.
Proof. intros E H eps He. destruct (H eps He) as [d Hd]. exists d. intros h. rewrite <- !E. apply Hd. Qed.

Lemma derivable_value f x l l' : derivable_pt_lim f x l -> l = l' -> derivable_pt_lim f x l'.
Proof. now intros H <-. Qed.

Lemma derivable_weights a A f f' b B g g' x : derivable_pt_lim f x f' -> derivable_pt_lim g x g' ->
  derivable_pt_lim (fun y => (y - a) * A * f y + (b - y) * B * g y) x
    (A * f x + (x - a) * A * f' - B * g x + (b - x) * B * g').
Proof.
  intros Hf Hg.
  replace (A * f x + _ - _ + _) with
    (((1 - 0) * A + (x - a) * 0) * f x + (x - a) * A * f' + (((0 - 1) * B + (b - x) * 0) * g x + (b - x) * B * g')) by ring.
  apply (derivable_pt_lim_plus (fun y => (y - a) * A * f y) (fun y => (b - y) * B * g y)).
  - apply (derivable_pt_lim_mult (fun y => (y - a) * A) f); [|exact Hf].
    apply (derivable_pt_lim_mult (fun y => y - a) (fun _ => A)); [|apply derivable_pt_lim_const].
    apply (derivable_pt_lim_minus id (fun _ => a)); [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
  - apply (derivable_pt_lim_mult (fun y => (b - y) * B) g); [|exact Hg].
    apply (derivable_pt_lim_mult (fun y => b - y) (fun _ => B)); [|apply derivable_pt_lim_const].
    apply (derivable_pt_lim_minus (fun _ => b) id); [apply derivable_pt_lim_const|apply derivable_pt_lim_id].
Qed.

(** What is left of the derivative formula when all that cancels has cancelled: A, B, D are the reciprocals of
    t_(i+p) - t_i, t_(i+p+1) - t_(i+1) and t_(i+p) - t_(i+1). *)
Lemma spans_cancel t i p : ascending t -> (S i <= p)%nat ->
  quo 1 (t p - t (S i)) * (quo 1 (t (S p) - t (S i)) * (t (S p) - t (S i)) - quo 1 (t p - t i) * (t p - t i)) = 0.
Proof.
  intros up Hp. destruct (Req_EM_T (t p - t (S i)) 0) as [E|E].
  - unfold quo at 1. destruct (Req_EM_T (t p - t (S i)) 0); [ring|contradiction].
  - assert (t (S i) <= t p) by now apply ascending_le. pose proof (up i). pose proof (up p).
    rewrite (Rmult_comm (quo 1 (t (S p) - _))), (Rmult_comm (quo 1 (t p - t i))), !quo_one by lra. ring.
Qed.

(** B_i' = p B_(i,p-1) / (t_(i+p) - t_i) - p B_(i+1,p-1) / (t_(i+p+1) - t_(i+1)), whatever the functions of degree 0. *)
Theorem cox_derivative d t : ascending t -> forall q i x, derivable_pt_lim (cox d t (S q) i) x
  (INR (S q) * (quo (cox d t q i x) (t (i + S q)%nat - t i)
    - quo (cox d t q (S i) x) (t (S i + S q)%nat - t (S i)))).
Proof.
  intros up q. induction q as [|q IH]; intros i x;
    apply (derivable_ext _ _ _ _ (fun y => eq_sym (cox_step d t _ i y)));
    rewrite (quo_mult (cox d t _ i x)), (quo_mult (cox d t _ (S i) x)).
  - eapply derivable_value; [apply derivable_weights; apply derivable_pt_lim_const|]. cbn [INR cox]. ring.
  - eapply derivable_value; [apply derivable_weights; apply IH|].
    rewrite !cox_step, (S_INR (S q)), (quo_mult (cox d t q i x)), (quo_mult (cox d t q (S (S i)) x)),
      !(quo_mult (cox d t q (S i) x)).
    pose proof (spans_cancel t i (i + S (S q)) up ltac:(lia)) as C.
    replace (S i + S q)%nat with (i + S (S q))%nat by lia.
    replace (S (S i) + S q)%nat with (S i + S (S q))%nat by lia.
    change (S (i + S (S q))) with (S i + S (S q))%nat in C.
    set (D := quo 1 (t (i + S (S q))%nat - t (S i))) in *.
    set (B := quo 1 (t (S i + S (S q))%nat - t (S i))) in *.
    set (A := quo 1 (t (i + S (S q))%nat - t i)) in *.
    generalize (quo 1 (t (i + S q)%nat - t i)) (quo 1 (t (S i + S (S q))%nat - t (S (S i)))); intros a b.
    generalize (cox d t q i x) (cox d t q (S i) x) (cox d t q (S (S i)) x) (INR (S q)); intros n0 n1 n2 n.
    apply Rminus_diag_uniq. match type of C with ?c = 0 => transitivity (n * n1 * c); [ring|rewrite C; ring] end.
Qed.

(** Derivatives on a set: limits of difference quotients inside of it. *)
Definition derivative_on (D : R -> Prop) (f g : R -> R) : Prop := forall x, D x -> D_in f g D x.

(** The k-th derivative of f on D is g. *)
Fixpoint derivatives_on (D : R -> Prop) (k : nat) (f g : R -> R) : Prop :=
  match k with
  | O => forall x, D x -> f x = g x
  | S j => exists h, derivative_on D f h /\ derivatives_on D j h g
  end.

(** No point of D stands alone, so that derivatives on D are unique. *)
Definition dense (D : R -> Prop) : Prop := forall x, D x -> adhDa (D_x D x) x.

Lemma derivative_ext (D : R -> Prop) f f' g g' : (forall x, D x -> f x = f' x) -> (forall x, D x -> g x = g' x) ->
  derivative_on D f g -> derivative_on D f' g'.
Proof.
  intros Ef Eg H x Hx eps He. destruct (H x Hx eps He) as (a & Ha & Hd). exists a. split; [exact Ha|].
  intros y Hy. rewrite <- (Ef x), <- (Ef y), <- (Eg x) by (try apply Hy; exact Hx). now apply Hd.
Qed.

Lemma derivatives_ext (D : R -> Prop) k : forall f f' g g', (forall x, D x -> f x = f' x) -> (forall x, D x -> g x = g' x) ->
  derivatives_on D k f g -> derivatives_on D k f' g'.
Proof.
  induction k as [|k IH]; intros f f' g g' Ef Eg H.
  - intros x Hx. rewrite <- Ef, <- Eg by exact Hx. now apply H.
  - destruct H as (h & Hf & Hh). exists h. split; [now apply (derivative_ext D f f' h h)|].
    apply (IH h h g g'); auto.
Qed.

Lemma derivatives_subset (D E : R -> Prop) k : (forall x, E x -> D x) -> forall f g,
  derivatives_on D k f g -> derivatives_on E k f g.
Proof.
  intro HE. induction k as [|k IH]; intros f g H.
  - intros x Hx. apply H. auto.
  - destruct H as (h & Hf & Hh). exists h. split; [|now apply IH]. intros x Hx eps He.
    destruct (Hf x (HE x Hx) eps He) as (a & Ha & Hd). exists a. split; [exact Ha|].
    intros y [[Ey Hne] Hy]. apply Hd. split; [split|]; auto.
Qed.

Lemma derivatives_unique (D : R -> Prop) k : dense D -> forall f g h, derivatives_on D k f g -> derivatives_on D k f h ->
  forall x, D x -> g x = h x.
Proof.
  intro HD. induction k as [|k IH]; intros f g h Hg Hh x Hx.
  - rewrite <- Hg, <- Hh; auto.
  - destruct Hg as (g' & Fg & Gg), Hh as (h' & Fh & Hh). apply (IH g' g h Gg); [|exact Hx].
    apply (derivatives_ext D k h' g' h h); [|auto|exact Hh]. intros y Hy.
    apply (single_limit (fun z => (f z - f y) / (z - y)) (D_x D y) (h' y) (g' y) y); [now apply HD|exact (Fh y Hy)|exact (Fg y Hy)].
Qed.

Lemma derivative_of (D : R -> Prop) f g : (forall x, derivable_pt_lim f x (g x)) -> derivative_on D f g.
Proof.
  intros H x _ eps He. destruct (H x eps He) as [d Hd]. exists d. split; [apply cond_pos|].
  intros y [[_ Hne] Hy]. cbn in y. specialize (Hd (y - x)). replace (x + (y - x)) with y in Hd by ring.
  apply Hd; [intro E; apply Hne; lra|exact Hy].
Qed.

Lemma dense_span t k : dense (span t k).
Proof.
  intros x Hx a Ha. unfold span in *. exists (x + Rmin a (t (S k) - x) / 2).
  pose proof (Rmin_l a (t (S k) - x)). pose proof (Rmin_r a (t (S k) - x)).
  assert (0 < Rmin a (t (S k) - x)) by (apply Rmin_pos; lra).
  split; [split; [lra|intro E; lra]|]. cbn. unfold R_dist. rewrite Rabs_right; lra.
Qed.

(** On one span a curve is one polynomial. *)
Definition piece (k m : nat) (t : nat -> R) (p : nat) (P : nat -> R) (x : R) : R :=
  sum (S m) (fun i => P i * cox (delta k) t p i x).

Lemma spline_piece t k m p P x : ascending t -> span t k x -> spline m t p P x = piece k m t p P x.
Proof. intros up H. apply sum_ext. intros i _. now rewrite (N_piece t up k x H). Qed.

Lemma derivable_sum n (P f' : nat -> R) (f : nat -> R -> R) x : (forall i, derivable_pt_lim (f i) x (f' i)) ->
  derivable_pt_lim (fun y => sum n (fun i => P i * f i y)) x (sum n (fun i => P i * f' i)).
Proof.
  intro H. induction n as [|n IH]; cbn; [apply derivable_pt_lim_const|].
  apply (derivable_pt_lim_plus (fun y => sum n (fun i => P i * f i y)) (fun y => P n * f n y)); [exact IH|].
  apply (derivable_pt_lim_scal (f n)), H.
Qed.

Lemma sum_by_parts n (P c : nat -> R) : sum (S n) (fun i => P i * (c i - c (S i)))
  = P O * c O - P n * c (S n) + sum n (fun i => (P (S i) - P i) * c (S i)).
Proof. induction n as [|n IH]; [cbn; ring|]. cbn [sum] in *. rewrite IH. ring. Qed.

(** Control points of the derivative, over the knots without the first one. *)
Definition dpoints (t : nat -> R) (p : nat) (P : nat -> R) (i : nat) : R :=
  quo (INR p * (P (S i) - P i)) (t (S i + p)%nat - t (S i)).

(** The derivative of a curve is a curve of one degree less: P_i' = p (P_(i+1) - P_i) / (t_(i+p+1) - t_(i+1)). *)
Lemma piece_derivative t q m P k : ascending t -> (S q <= k <= S m)%nat ->
  forall x, derivable_pt_lim (piece k (S m) t (S q) P) x (piece (k - 1) m (shift t) q (dpoints t (S q) P) x).
Proof.
  intros up Hk x. eapply derivable_value; [apply derivable_sum; intro; now apply cox_derivative|].
  set (c i := INR (S q) * quo 1 (t (i + S q)%nat - t i) * cox (delta k) t q i x).
  transitivity (sum (S (S m)) (fun i => P i * (c i - c (S i)))).
  { apply sum_ext. intros i _. unfold c. rewrite !(quo_mult (cox _ _ _ _ _)). ring. }
  rewrite sum_by_parts. unfold c at 1 2.
  rewrite (cox_zero _ t q 0) by (intros; apply delta_0; lia).
  rewrite (cox_zero _ t q (S (S m))) by (intros; apply delta_0; lia).
  rewrite !Rmult_0_r, Rminus_0_r, Rplus_0_l. apply sum_ext. intros i _.
  unfold c, dpoints. rewrite (quo_mult (INR _ * _)), <- cox_shift.
  rewrite (cox_ext (fun j => delta k (S j)) (delta (k - 1))); [ring|].
  intros j _. unfold delta. destruct (Nat.eq_dec (S j) k), (Nat.eq_dec j (k - 1)); lia || reflexivity.
Qed.

Theorem spline_derivative t q m P k : ascending t -> (S q <= k <= S m)%nat ->
  derivative_on (span t k) (spline (S m) t (S q) P) (spline m (shift t) q (dpoints t (S q) P)).
Proof.
  intros up Hk. assert (ascending (shift t)) by (intro; apply up).
  apply (derivative_ext _ (piece k (S m) t (S q) P) _ (piece (k - 1) m (shift t) q (dpoints t (S q) P))).
  - intros x Hx. now rewrite (spline_piece t k).
  - intros x Hx. rewrite (spline_piece (shift t) (k - 1)); [reflexivity|assumption|].
    unfold span, shift in *. now replace (S (k - 1)) with k by lia.
  - apply derivative_of. now apply piece_derivative.
Qed.

(** A piece of degree 0 does not change. *)
Lemma piece_derivative_0 t m P k x : derivable_pt_lim (piece k m t 0 P) x 0.
Proof. exact (derivable_pt_lim_const (sum (S m) (fun i => P i * delta k i)) x). Qed.
