(** B-splines by the recursion of Cox and de Boor, with its comparisons and its 0/0 = 0; degree p is order p + 1.

    Knots are an endless ascending sequence, of which t_0 .. t_(m+p+1) matter; a finite vector repeats its last knot. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums.
Open Scope R_scope.

Definition quo (a b : R) : R := if Req_EM_T b 0 then 0 else a / b.
Definition inside (a b x : R) : R := if Rle_dec a x then if Rlt_dec x b then 1 else 0 else 0.

(** The recursion over any functions of degree 0. *)
Fixpoint cox (d t : nat -> R) (p i : nat) (x : R) : R :=
  match p with
  | O => d i
  | S q => quo (x - t i) (t (i + p)%nat - t i) * cox d t q i x
         + quo (t (S i + p)%nat - x) (t (S i + p)%nat - t (S i)) * cox d t q (S i) x
  end.

(** B_(i,p+1)(x; t), and the curve with control points P_0 .. P_m. *)
Definition N (t : nat -> R) (p i : nat) (x : R) : R := cox (fun j => inside (t j) (t (S j)) x) t p i x.
Definition spline (m : nat) (t : nat -> R) (p : nat) (P : nat -> R) (x : R) : R := sum (S m) (fun i => P i * N t p i x).

Definition ascending (t : nat -> R) : Prop := forall i, t i <= t (S i).
Definition span (t : nat -> R) (k : nat) (x : R) : Prop := t k <= x < t (S k).
Definition delta (k i : nat) : R := if Nat.eq_dec i k then 1 else 0.

Lemma ascending_le t : ascending t -> forall i j, (i <= j)%nat -> t i <= t j.
Proof. intros H i j Hij. induction Hij; [lra|]. specialize (H m). lra. Qed.

Lemma quo_mult a b : quo a b = a * quo 1 b.
Proof. unfold quo. destruct (Req_EM_T b 0); [ring|now field]. Qed.

Lemma quo_one b : b <> 0 -> b * quo 1 b = 1.
Proof. intro H. unfold quo. destruct (Req_EM_T b 0); [contradiction|now field]. Qed.

Lemma quo_div a b : b <> 0 -> quo a b = a / b.
Proof. intro H. unfold quo. now destruct (Req_EM_T b 0). Qed.

Lemma quo_nonneg a b : 0 <= a -> 0 <= b -> 0 <= quo a b.
Proof.
  intros Ha Hb. unfold quo. destruct (Req_EM_T b 0); [lra|].
  apply Rmult_le_pos; [exact Ha | left; apply Rinv_0_lt_compat; lra].
Qed.

Lemma inside_1 a b x : a <= x < b -> inside a b x = 1.
Proof. intro H. unfold inside. destruct (Rle_dec a x), (Rlt_dec x b); lra. Qed.

Lemma inside_0 a b x : x < a \/ b <= x -> inside a b x = 0.
Proof. intro H. unfold inside. destruct (Rle_dec a x), (Rlt_dec x b); lra. Qed.

Lemma delta_1 k : delta k k = 1.
Proof. unfold delta. now destruct (Nat.eq_dec k k). Qed.

Lemma delta_0 k i : i <> k -> delta k i = 0.
Proof. intro H. unfold delta. now destruct (Nat.eq_dec i k). Qed.

Lemma cox_step d t q i x : cox d t (S q) i x =
  (x - t i) * quo 1 (t (i + S q)%nat - t i) * cox d t q i x
  + (t (S i + S q)%nat - x) * quo 1 (t (S i + S q)%nat - t (S i)) * cox d t q (S i) x.
Proof. cbn [cox]. now rewrite (quo_mult (x - t i)), (quo_mult (t (S i + S q)%nat - x)). Qed.

Lemma N_step t q i x : N t (S q) i x = quo (x - t i) (t (i + S q)%nat - t i) * N t q i x
  + quo (t (S i + S q)%nat - x) (t (S i + S q)%nat - t (S i)) * N t q (S i) x.
Proof. reflexivity. Qed.

Lemma cox_ext d e t p : forall i x, (forall j, (i <= j <= i + p)%nat -> d j = e j) -> cox d t p i x = cox e t p i x.
Proof.
  induction p as [|q IH]; intros i x H; cbn [cox]; [apply H; lia|].
  rewrite (IH i), (IH (S i)); [reflexivity| |]; intros j Hj; apply H; lia.
Qed.

Lemma cox_knots d s t p i : (forall j, (i <= j <= S (i + p))%nat -> s j = t j) -> forall x, cox d s p i x = cox d t p i x.
Proof.
  revert i. induction p as [|q IH]; intros i H x; cbn [cox]; [reflexivity|].
  rewrite (IH i), (IH (S i)), !H by (try intros; try apply H; lia). reflexivity.
Qed.

Lemma cox_zero d t p : forall i x, (forall j, (i <= j <= i + p)%nat -> d j = 0) -> cox d t p i x = 0.
Proof.
  induction p as [|q IH]; intros i x H; cbn [cox]; [apply H; lia|].
  rewrite (IH i), (IH (S i)); [ring| |]; intros j Hj; apply H; lia.
Qed.

(** Over the same knots shifted by one. *)
Definition shift (t : nat -> R) (i : nat) : R := t (S i).

Lemma cox_shift d t p : forall i x, cox (fun j => d (S j)) (shift t) p i x = cox d t p (S i) x.
Proof. induction p as [|q IH]; intros i x; cbn [cox]; [reflexivity|]. now rewrite !IH. Qed.

Lemma N_shift t p i x : N (shift t) p i x = N t p (S i) x.
Proof. unfold N, shift. exact (cox_shift (fun j => inside (t j) (t (S j)) x) t p i x). Qed.

(** A function depends on its own p + 2 knots alone. *)
Theorem own_knots s t p i : (forall j, (i <= j <= S (i + p))%nat -> s j = t j) -> forall x, N s p i x = N t p i x.
Proof.
  intros H x. unfold N. rewrite (cox_ext _ (fun j => inside (t j) (t (S j)) x)); [now apply cox_knots|].
  intros j Hj. now rewrite !H by lia.
Qed.

Section Ascending.
Variable t : nat -> R.
Hypothesis up : ascending t.
Local Ltac knots i j := pose proof (ascending_le t up i j ltac:(lia)).

(** On one span the functions of degree 0 are constant, and all others polynomials. *)
Lemma inside_span k x : span t k x -> forall j, inside (t j) (t (S j)) x = delta k j.
Proof.
  intros H j. destruct (Nat.lt_trichotomy j k) as [Hj|[->|Hj]].
  - knots (S j) k. rewrite delta_0 by lia. apply inside_0. right. destruct H. lra.
  - rewrite delta_1. now apply inside_1.
  - knots (S k) j. rewrite delta_0 by lia. apply inside_0. left. destruct H. lra.
Qed.

Lemma N_piece k x : span t k x -> forall p i, N t p i x = cox (delta k) t p i x.
Proof. intros H p i. apply cox_ext. intros. now apply inside_span. Qed.

(** B_(i,p+1) vanishes outside of t_i .. t_(i+p+1). *)
Theorem local_support p i x : x < t i \/ t (S (i + p)) <= x -> N t p i x = 0.
Proof.
  intro H. apply cox_zero. intros j Hj. apply inside_0. knots i j. knots (S j) (S (i + p)). lra.
Qed.

Theorem non_negative p i x : 0 <= N t p i x.
Proof.
  revert i. induction p as [|q IH]; intro i.
  - cbn. unfold inside. destruct (Rle_dec (t i) x), (Rlt_dec x (t (S i))); lra.
  - rewrite N_step. apply Rplus_le_le_0_compat.
    + destruct (Rlt_dec x (t i)); [rewrite local_support by (now left); lra|].
      apply Rmult_le_pos; [apply quo_nonneg|apply IH]; [lra|]. knots i (i + S q)%nat. lra.
    + destruct (Rle_dec (t (S i + S q)%nat) x).
      * rewrite local_support; [lra|right]. now replace (S (S i + q)) with (S i + S q)%nat by lia.
      * apply Rmult_le_pos; [apply quo_nonneg|apply IH]; [lra|]. knots (S i) (S i + S q)%nat. lra.
Qed.

(** And is positive inside of it. *)
Theorem positive_inside p i k x : t k < x < t (S k) -> (i <= k <= i + p)%nat -> 0 < N t p i x.
Proof.
  intro Hx. revert i. induction p as [|q IH]; intros i Hi.
  - replace i with k by lia. cbn. rewrite inside_1; lra.
  - rewrite N_step. pose proof (non_negative q i x). pose proof (non_negative q (S i) x).
    knots i k. knots (S k) (S (i + S q)).
    destruct (le_lt_dec k (i + q)) as [L|L].
    + knots (S k) (i + S q)%nat. apply Rplus_lt_le_0_compat.
      * apply Rmult_lt_0_compat; [|apply IH; lia]. rewrite quo_div by lra. apply Rdiv_lt_0_compat; lra.
      * apply Rmult_le_pos; [apply quo_nonneg|assumption]; [change (S i + S q)%nat with (S (i + S q)); lra|].
        knots (S i) (S i + S q)%nat. lra.
    + apply Rplus_le_lt_0_compat.
      * apply Rmult_le_pos; [apply quo_nonneg|assumption]; [lra|]. knots i (i + S q)%nat. lra.
      * knots (S i) k. change (S i + S q)%nat with (S (i + S q)).
        apply Rmult_lt_0_compat; [|apply IH; lia]. rewrite quo_div by lra. apply Rdiv_lt_0_compat; lra.
Qed.

Lemma some_span p m x : t p <= x < t (S m) -> exists k, (p <= k <= m)%nat /\ span t k x.
Proof.
  intros [Hp Hm]. induction m as [|m IH]; [|destruct (Rlt_dec x (t (S m))) as [Hx|Hx]].
  - exists O. unfold span. destruct p; [intuition lia|knots 1%nat (S p); lra].
  - destruct (IH Hx) as (k & Hk & Hs). exists k. split; [lia|exact Hs].
  - exists (S m). unfold span. destruct (le_lt_dec p (S m)) as [H|H]; [intuition (lia || lra)|].
    knots (S (S m)) p. lra.
Qed.

(** Both weights of a function in the recursion add up to one, or it vanishes. *)
Lemma weights_add q i x : quo (x - t i) (t (i + S q)%nat - t i) * N t q i x
  + quo (t (i + S q)%nat - x) (t (i + S q)%nat - t i) * N t q i x = N t q i x.
Proof.
  destruct (Req_EM_T (t (i + S q)%nat - t i) 0) as [E|E].
  - rewrite local_support; [ring|]. replace (S (i + q)) with (i + S q)%nat by lia.
    destruct (Rlt_dec x (t i)); [now left|right; lra].
  - rewrite !quo_div by exact E. now field.
Qed.

(** The functions over a clamped or unclamped vector add up to one on t_p .. t_(m+1). *)
Theorem partition_of_unity p m x : (p <= m)%nat -> t p <= x < t (S m) -> sum (S m) (fun i => N t p i x) = 1.
Proof.
  revert m. induction p as [|q IH]; intros m Hm Hx.
  - destruct (some_span 0 m x Hx) as (k & Hk & Hs).
    rewrite (sum_single _ k) by (try lia; intros; rewrite (N_piece k) by exact Hs; now apply delta_0).
    rewrite (N_piece k) by exact Hs. apply delta_1.
  - transitivity (sum (S m) (fun i => quo (x - t i) (t (i + S q)%nat - t i) * N t q i x)
      + sum (S m) (fun i => quo (t (S i + S q)%nat - x) (t (S i + S q)%nat - t (S i)) * N t q (S i) x)).
    { rewrite <- sum_add. apply sum_ext. reflexivity. }
    rewrite (sum_first m). cbn [sum Nat.add].
    rewrite (local_support q 0) by (right; cbn; lra). rewrite (local_support q (S m)) by (left; lra).
    rewrite Rmult_0_r, Rmult_0_r, Rplus_0_r, Rplus_0_l, <- sum_add.
    transitivity (sum (S m) (fun i => N t q i x)).
    + rewrite sum_first, (local_support q 0) by (right; cbn; lra). rewrite Rplus_0_l.
      apply sum_ext. intros i _. exact (weights_add q (S i) x).
    + apply IH; [lia|]. specialize (up q). lra.
Qed.
End Ascending.
