(** The semi-structured surface, (1) to (3): curve i has knots V_i and n_i + 1 control points of its own; its evaluation,
    hull and locality; and contact of surfaces at every v, from control points and back to them. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives Independence Contact Mirror.
Open Scope R_scope.

Section Surface.
Variables (m : nat) (U : nat -> R) (p : nat) (n : nat -> nat) (V : nat -> nat -> R) (l : nat).

(** (2), curve i; (1) as a double sum; (3), the sum of curves. *)
Definition curve (P : nat -> nat -> R) i v := spline (n i) (V i) l (P i) v.
Definition surface (P : nat -> nat -> R) u v :=
  sum (S m) (fun i => sum (S (n i)) (fun j => P i j * (N (V i) l j v * N U p i u))).

Theorem equation_3 P u v : surface P u v = spline m U p (fun i => curve P i v) u.
Proof.
  apply sum_ext. intros i _. unfold curve, spline. rewrite Rmult_comm, <- sum_scale.
  apply sum_ext. intros. ring.
Qed.

Hypotheses (up : ascending U) (upV : forall i, ascending (V i)).

(** A control point moves the surface on its own rectangle of knots alone. *)
Theorem locality u v P Q i0 j0 : (forall i j, ~ (i = i0 /\ j = j0) -> P i j = Q i j) ->
  u < U i0 \/ U (S (i0 + p)) <= u \/ v < V i0 j0 \/ V i0 (S (j0 + l)) <= v -> surface P u v = surface Q u v.
Proof.
  intros H Out. apply sum_ext. intros i _. apply sum_ext. intros j _.
  destruct (Nat.eq_dec i i0) as [->|], (Nat.eq_dec j j0) as [->|]; [|rewrite H by tauto; ring..].
  assert (Z : N (V i0) l j0 v * N U p i0 u = 0); [|rewrite Z; ring].
  destruct Out as [O|[O|O]].
  - rewrite (local_support U up p i0) by tauto. ring.
  - rewrite (local_support U up p i0) by tauto. ring.
  - rewrite (local_support (V i0) (upV i0) l j0) by tauto. ring.
Qed.

Hypotheses (Hp : (p <= m)%nat) (Hl : forall i, (l <= n i)%nat).
Variables u v : R.
Hypotheses (Hu : U p <= u < U (S m)) (Hv : forall i, V i l <= v < V i (S (n i))).

(** Weights that are not negative and add up to one: hull and affine invariance. *)
Theorem weights_non_negative i j : 0 <= N (V i) l j v * N U p i u.
Proof. apply Rmult_le_pos; now apply non_negative. Qed.

Theorem weights_add_up : surface (fun _ _ => 1) u v = 1.
Proof.
  rewrite equation_3. transitivity (sum (S m) (fun i => N U p i u)); [|now apply partition_of_unity].
  apply sum_ext. intros i _. unfold curve, spline.
  rewrite (sum_ext _ _ (fun j => N (V i) l j v)) by (intros; ring). rewrite partition_of_unity by auto. ring.
Qed.

Theorem affine_invariance P a b : surface (fun i j => a * P i j + b) u v = a * surface P u v + b.
Proof.
  transitivity (a * surface P u v + b * surface (fun _ _ => 1) u v); [|rewrite weights_add_up; ring].
  unfold surface. rewrite <- !sum_scale, <- sum_add. apply sum_ext. intros i _.
  rewrite <- !sum_scale, <- sum_add. apply sum_ext. intros. ring.
Qed.

Theorem convex_hull P a : (forall i j, (i <= m)%nat -> (j <= n i)%nat -> a <= P i j) -> a <= surface P u v.
Proof.
  intro H. apply Rge_le, Rminus_ge, Rle_ge.
  replace (surface P u v - a) with (surface (fun i j => 1 * P i j + - a) u v) by (rewrite affine_invariance; ring).
  apply sum_nonneg. intros i Hi. apply sum_nonneg. intros j Hj.
  apply Rmult_le_pos; [specialize (H i j ltac:(lia) ltac:(lia)); lra|apply weights_non_negative].
Qed.
End Surface.

(** With one vector for all curves it is the classical surface, and the order of evaluation is free. *)
Theorem classical m U p n V l P u v : surface m U p (fun _ => n) (fun _ => V) l P u v =
  spline n V l (fun j => spline m U p (fun i => P i j) u) v.
Proof.
  unfold surface, spline. rewrite sum_swap. apply sum_ext. intros j _. rewrite Rmult_comm, <- sum_scale.
  apply sum_ext. intros. ring.
Qed.

(** One step of de Boor's triangle, and the whole of it. *)
Definition step (t : nat -> R) (p : nat) (x : R) (P : nat -> R) (i : nat) : R :=
  (x - t i) / (t (i + p)%nat - t i) * P i + (t (i + p)%nat - x) / (t (i + p)%nat - t i) * P (i - 1)%nat.
Fixpoint triangle (t : nat -> R) (p : nat) (x : R) (P : nat -> R) (k : nat) : R :=
  match p with O => P k | S q => triangle t q x (step t p x P) k end.

Lemma N_outside t p k i x : ascending t -> span t k x -> (i < k - p \/ k < i)%nat -> N t p i x = 0.
Proof.
  intros up H Hi. rewrite (N_piece t up k x H). apply cox_zero. intros j Hj. apply delta_0. lia.
Qed.

Theorem de_boor t p m k x P : ascending t -> (p <= k <= m)%nat -> span t k x -> spline m t p P x = triangle t p x P k.
Proof.
  intros up. revert P. induction p as [|q IH]; intros P Hk Hs.
  - unfold spline. rewrite (sum_single _ k); [|lia|].
    + rewrite (N_piece t up k x Hs). cbn. rewrite delta_1. ring.
    + intros i _ Hi. rewrite (N_piece t up k x Hs). cbn. rewrite delta_0 by assumption. ring.
  - cbn [triangle]. rewrite <- IH by (auto; lia). unfold spline.
    transitivity (sum (S m) (fun i => P i * (quo (x - t i) (t (i + S q)%nat - t i) * N t q i x))
      + sum (S m) (fun i => P i * (quo (t (S i + S q)%nat - x) (t (S i + S q)%nat - t (S i)) * N t q (S i) x))).
    { rewrite <- sum_add. apply sum_ext. intros i _. rewrite N_step. ring. }
    rewrite !(sum_first m (fun i => _ * N t q i x)), (sum_first m (fun i => _ * (_ * N t q i x))). cbn [sum].
    rewrite (N_outside t q k 0 x), (N_outside t q k (S m) x) by (auto; lia).
    rewrite !Rmult_0_r, Rplus_0_r, !Rplus_0_l, <- sum_add. apply sum_ext. intros i Hi. unfold step. cbn [Nat.sub]. rewrite Nat.sub_0_r.
    destruct (le_lt_dec (k - q) (S i)); [destruct (le_lt_dec (S i) k)|];
      [|rewrite (N_outside t q k (S i) x) by (auto; lia); ring..].
    destruct Hs as [H1 H2]. pose proof (ascending_le t up (S i) k ltac:(lia)).
    pose proof (ascending_le t up (S k) (S i + S q) ltac:(lia)). rewrite !quo_div by lra. field. lra.
Qed.

(** Derivatives at the end are linear in the control points, so those of a surface are curves of base and blend. *)
Lemma differences_linear k : forall q u n (Q : nat -> nat -> R) b,
  differences k q u (fun i => sum n (fun j => Q i j * b j)) = sum n (fun j => differences k q u (fun i => Q i j) * b j).
Proof.
  induction k as [|k IH]; intros q u n Q b; [reflexivity|]. destruct q as [|q]; cbn [differences].
  - symmetry. apply sum_zero. intros. ring.
  - rewrite <- IH. apply differences_ext. intros i _. unfold Rdiv.
    transitivity (INR (S q) * / u (S i) * (sum n (fun j => Q (S i) j * b j) + -1 * sum n (fun j => Q i j * b j))); [ring|].
    rewrite <- sum_scale, <- sum_add, <- sum_scale. apply sum_ext. intros. ring.
Qed.

Lemma sum_of_splines n V l r (c : nat -> R) (Q : nat -> nat -> R) v :
  sum r (fun k => c k * spline n V l (Q k) v) = spline n V l (fun j => sum r (fun k => c k * Q k j)) v.
Proof.
  unfold spline. transitivity (sum r (fun k => sum (S n) (fun j => c k * (Q k j * N V l j v)))).
  - apply sum_ext. intros. now rewrite sum_scale.
  - rewrite sum_swap. apply sum_ext. intros j _. rewrite Rmult_comm, <- sum_scale. apply sum_ext. intros. ring.
Qed.

(** Contact of a semi-structured blend with a base over V, at every v of the domain of the base. The first rows of the
    blend are curves over V, with control points P; further rows are what they are. *)
Section Contact.
Variables (c : nat -> R) (o : nat) (m : nat) (t : nat -> R) (p : nat) (rows : nat -> R -> R).
Variables (m' : nat) (w : nat -> R) (q : nat) (n : nat) (V : nat -> R) (l : nat) (P Q : nat -> nat -> R).
Hypotheses (up : ascending t) (Ct : clamped t p) (up' : ascending w) (Cw : clamped w q).
Hypotheses (Ho : (o <= p <= m)%nat) (Hq : (q <= m')%nat).
Hypotheses (upV : ascending V) (CV : clamped V l) (EV : clamped_end V l n) (PV : proper V l n).
Hypothesis first_rows : forall i v, (i <= o)%nat -> rows i v = spline n V l (P i) v.

Definition surfaces_meet : Prop := forall v, V l <= v < V (S n) ->
  contact_by c o m t p (fun i => rows i v) m' w q (fun i => spline n V l (Q i) v).

Theorem contact_of_surfaces : surfaces_meet <-> forall j, (j <= n)%nat ->
  contact_by c o m t p (fun i => P i j) m' w q (fun i => Q i j).
Proof.
  set (r i j := sum (S i) (fun k => weight t p i k * (c k * differences k q (knot w q) (fun i => Q i j)))).
  assert (E : forall i v, sum (S i) (fun k => weight t p i k * (c k *
    differences k q (knot w q) (fun i => spline n V l (Q i) v))) = spline n V l (r i) v).
  { intros i v.
    transitivity (sum (S i) (fun k => weight t p i k * c k *
      spline n V l (fun j => differences k q (knot w q) (fun i => Q i j)) v)).
    - apply sum_ext. intros k _. unfold spline at 1. rewrite differences_linear. unfold spline. ring.
    - rewrite (sum_of_splines n V l (S i) (fun k => weight t p i k * c k)
        (fun k j => differences k q (knot w q) (fun i => Q i j))).
      apply sum_ext. intros j _. f_equal. apply sum_ext. intros. ring. }
  split.
  - intros H j Hj. apply contact_rows_by; auto. intros i Hi.
    apply (same_points V l n (P i) (r i)); auto. intros v Hv.
    rewrite <- first_rows, <- E by exact Hi. pose proof (H v Hv) as K. rewrite contact_rows_by in K by auto. now apply K.
  - intros H v Hv. apply contact_rows_by; auto. intros i Hi. rewrite E, first_rows by exact Hi.
    apply sum_ext. intros j Hj. f_equal. specialize (H j ltac:(lia)). rewrite contact_rows_by in H by auto.
    now apply H.
Qed.
End Contact.
