(** Sums over i < n. The library's [sum_f_R0] includes its end and has no empty sum. *)
From Coq Require Import Reals Lia.
Open Scope R_scope.

Fixpoint sum (n : nat) (f : nat -> R) : R :=
  match n with O => 0 | S k => sum k f + f k end.

Lemma sum_ext n f g : (forall i, (i < n)%nat -> f i = g i) -> sum n f = sum n g.
Proof.
  induction n as [|n IH]; intro H; [reflexivity | cbn].
  rewrite IH by (intros; apply H; lia). now rewrite H by lia.
Qed.

Lemma sum_zero n f : (forall i, (i < n)%nat -> f i = 0) -> sum n f = 0.
Proof.
  intro H. rewrite (sum_ext n f (fun _ => 0) H). clear H. induction n; cbn; [|rewrite IHn]; ring.
Qed.

Lemma sum_add n f g : sum n (fun i => f i + g i) = sum n f + sum n g.
Proof. induction n as [|n IH]; cbn; [|rewrite IH]; ring. Qed.

Lemma sum_scale n c f : sum n (fun i => c * f i) = c * sum n f.
Proof. induction n as [|n IH]; cbn; [|rewrite IH]; ring. Qed.

Lemma sum_first n f : sum (S n) f = f O + sum n (fun i => f (S i)).
Proof. induction n as [|n IH]; [cbn; ring|]. change (sum (S n) f + f (S n) = f O + sum (S n) (fun i => f (S i))).
  rewrite IH. cbn. ring. Qed.

Lemma sum_split m n f : sum (m + n) f = sum m f + sum n (fun i => f (m + i)%nat).
Proof.
  induction n as [|n IH]; [rewrite Nat.add_0_r; cbn; ring|].
  rewrite Nat.add_succ_r. cbn. rewrite IH. ring.
Qed.

Lemma sum_swap m n f : sum m (fun i => sum n (fun j => f i j)) = sum n (fun j => sum m (fun i => f i j)).
Proof.
  induction m as [|m IH]; cbn; [symmetry; now apply sum_zero|].
  rewrite IH, <- sum_add. reflexivity.
Qed.

Lemma sum_reverse n f : sum n f = sum n (fun i => f (n - S i)%nat).
Proof.
  induction n as [|n IH]; [reflexivity|].
  rewrite (sum_first n (fun i => f (S n - S i)%nat)), Nat.sub_succ, Nat.sub_0_r. cbn [sum]. rewrite IH.
  apply Rplus_comm.
Qed.

Lemma sum_nonneg n f : (forall i, (i < n)%nat -> 0 <= f i) -> 0 <= sum n f.
Proof.
  induction n as [|n IH]; intro H; cbn; [apply Rle_refl|].
  apply Rplus_le_le_0_compat; [apply IH; intros; apply H; lia | apply H; lia].
Qed.

(** All terms but one vanish. *)
Lemma sum_single n j f : (j < n)%nat -> (forall i, (i < n)%nat -> i <> j -> f i = 0) -> sum n f = f j.
Proof.
  intros Hj H. replace n with (j + S (n - S j))%nat by lia. rewrite sum_split, sum_first, Nat.add_0_r.
  rewrite !sum_zero; [ring | |]; intros i Hi; apply H; lia.
Qed.
