(** B-splines are independent: on one span, and over the whole of a clamped vector. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives.
Open Scope R_scope.

Lemma quo_zero a b : 0 < b -> quo a b = 0 -> a = 0.
Proof. intros Hb H. rewrite quo_div in H by lra. apply (f_equal (Rmult b)) in H. field_simplify in H; lra. Qed.

(** A curve that vanishes on a span has control points zero there. *)
Theorem independent_on_span p : forall t m P k, ascending t -> (p <= k <= m)%nat -> t k < t (S k) ->
  (forall x, span t k x -> spline m t p P x = 0) -> forall i, (k - p <= i <= k)%nat -> P i = 0.
Proof.
  induction p as [|q IH]; intros t m P k up Hk Hw H i Hi.
  - replace i with k by lia. specialize (H (t k) ltac:(split; lra)). rewrite (spline_piece t k) in H by (auto; split; lra).
    unfold piece in H. rewrite (sum_single _ k) in H; cbn in *; [rewrite delta_1 in H; lra|lia|].
    intros j _ Hj. rewrite delta_0 by assumption. ring.
  - destruct m as [|m]; [lia|]. destruct k as [|k]; [lia|].
    assert (D0 : forall x, span t (S k) x -> spline m (shift t) q (dpoints t (S q) P) x = 0).
    { apply (derivatives_unique (span t (S k)) 1 (dense_span t (S k)) (spline (S m) t (S q) P)).
      - exists (spline m (shift t) q (dpoints t (S q) P)). split; [|now intros ? ?]. apply spline_derivative; auto; lia.
      - exists (fun _ => 0). split; [|now intros ? ?].
        apply (derivative_ext _ (fun _ => 0) _ (fun _ => 0)); [intros; symmetry; now apply H|reflexivity|].
        apply derivative_zero. }
    assert (E : forall j, (k - q <= j <= k)%nat -> P (S j) = P j).
    { intros j Hj. pose proof (IH (shift t) m _ k (ascending_shift t up) ltac:(lia) Hw D0 j ltac:(lia)) as Z.
      apply quo_zero in Z.
      - apply Rmult_integral in Z. destruct Z as [Z|Z]; [now apply not_0_INR in Z|lra].
      - pose proof (ascending_le t up (S j) (S k) ltac:(lia)).
        pose proof (ascending_le t up (S (S k)) (S j + S q) ltac:(lia)). lra. }
    assert (Same : forall n, (n <= S q)%nat -> P (S k - n)%nat = P (S k)).
    { induction n as [|n IHn]; intro Hn; [f_equal; lia|]. rewrite <- IHn, <- (E (S k - S n)%nat) by lia.
      f_equal; lia. }
    assert (K : P (S k) = 0).
    { specialize (H (t (S k)) ltac:(split; lra)). unfold spline in H.
      rewrite (sum_ext _ _ (fun j => P (S k) * N t (S q) j (t (S k)))) in H.
      - rewrite sum_scale, partition_of_unity in H; [lra|assumption|lia|].
        split; [now apply ascending_le; [|lia]|].
        pose proof (ascending_le t up (S (S k)) (S (S m)) ltac:(lia)). lra.
      - intros j Hj. destruct (le_lt_dec (S k - S q) j) as [H1|H1]; [destruct (le_lt_dec j (S k)) as [H2|H2]|].
        + f_equal. replace j with (S k - (S k - j))%nat by lia. apply Same. lia.
        + rewrite (N_piece t up (S k)) by (split; lra). rewrite cox_zero; [ring|]. intros. apply delta_0. lia.
        + rewrite (N_piece t up (S k)) by (split; lra). rewrite cox_zero; [ring|]. intros. apply delta_0. lia. }
    replace i with (S k - (S k - i))%nat by lia. rewrite Same by lia. exact K.
Qed.

(** p + 1 equal knots at the end as well, and no function that is zero everywhere. *)
Definition clamped_end (t : nat -> R) (p m : nat) : Prop :=
  (forall i, (i <= p)%nat -> t (S m + i)%nat = t (S m)) /\ t m < t (S m).
Definition proper (t : nat -> R) (p m : nat) : Prop := forall j, (j <= m)%nat -> t j < t (S (j + p)).

Lemma some_width t j n : t j < t (j + n)%nat -> exists k, (j <= k < j + n)%nat /\ t k < t (S k).
Proof.
  induction n as [|n IH]; intro H; [rewrite Nat.add_0_r in H; lra|].
  destruct (Rlt_dec (t (j + n)%nat) (t (S (j + n)))) as [L|L].
  - exists (j + n)%nat. split; [lia|exact L].
  - rewrite Nat.add_succ_r in H. destruct IH as (k & Hk & Hw); [lra|]. exists k. split; [lia|exact Hw].
Qed.

Lemma covering_span t p m j : clamped t p -> clamped_end t p m -> proper t p m -> (j <= m)%nat ->
  exists k, (p <= k <= m)%nat /\ (k - p <= j <= k)%nat /\ t k < t (S k).
Proof.
  intros [C _] [C' _] Hp Hj. specialize (Hp j Hj). rewrite <- Nat.add_succ_r in Hp.
  destruct (some_width t j (S p) Hp) as (k & Hk & Hw). exists k.
  assert (~ (k < p)%nat) by (intro; rewrite (C k), (C (S k)) in Hw by lia; lra).
  assert (~ (m < k)%nat).
  { intro. assert (E : k = (S m + (k - S m))%nat) by lia. rewrite E in Hw. rewrite <- Nat.add_succ_r in Hw.
    rewrite !C' in Hw by lia. lra. }
  repeat split; try lia. exact Hw.
Qed.

Theorem independent t p m P : ascending t -> clamped t p -> clamped_end t p m -> proper t p m ->
  (forall x, t p <= x < t (S m) -> spline m t p P x = 0) -> forall j, (j <= m)%nat -> P j = 0.
Proof.
  intros up C C' Hp H j Hj. destruct (covering_span t p m j C C' Hp Hj) as (k & Hk & Hj' & Hw).
  apply (independent_on_span p t m P k); auto. intros x Hx. apply H.
  pose proof (ascending_le t up p k ltac:(lia)). pose proof (ascending_le t up (S k) (S m) ltac:(lia)).
  destruct Hx. lra.
Qed.

Corollary same_points t p m P Q : ascending t -> clamped t p -> clamped_end t p m -> proper t p m ->
  (forall x, t p <= x < t (S m) -> spline m t p P x = spline m t p Q x) -> forall j, (j <= m)%nat -> P j = Q j.
Proof.
  intros up C C' Hp H j Hj. apply Rminus_diag_uniq.
  apply (independent t p m (fun i => P i - Q i)); auto. intros x Hx.
  transitivity (spline m t p P x - spline m t p Q x); [|rewrite H by exact Hx; ring]. unfold spline.
  transitivity (sum (S m) (fun i => P i * N t p i x) + -1 * sum (S m) (fun i => Q i * N t p i x)); [|ring].
  rewrite <- sum_scale, <- sum_add. apply sum_ext. intros. ring.
Qed.
