(** A knot is inserted by Boehm's rule: every function is a combination of two over the finer knots, and a curve keeps
    its points. The new knot z may be anywhere, on an old knot too. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives.
Open Scope R_scope.

Section Insertion.
Variables (t : nat -> R) (k : nat) (z : R).
Hypotheses (up : ascending t) (Hz : span t k z).

Definition finer (i : nat) : R := if Nat.leb i k then t i else if Nat.eqb i (S k) then z else t (i - 1)%nat.

Lemma finer_before i : (i <= k)%nat -> finer i = t i.
Proof. intro H. unfold finer. now rewrite (proj2 (Nat.leb_le i k) H). Qed.
Lemma finer_at : finer (S k) = z.
Proof. unfold finer. rewrite (proj2 (Nat.leb_gt (S k) k) ltac:(lia)), Nat.eqb_refl. reflexivity. Qed.
Lemma finer_after i : (k < i)%nat -> finer (S i) = t i.
Proof.
  intro H. unfold finer. rewrite (proj2 (Nat.leb_gt (S i) k) ltac:(lia)), (proj2 (Nat.eqb_neq (S i) (S k)) ltac:(lia)).
  f_equal. lia.
Qed.

Lemma finer_ascending : ascending finer.
Proof.
  destruct Hz as [H1 H2]. intro i. destruct (lt_eq_lt_dec i k) as [[L | ->]|L].
  - rewrite !finer_before by lia. apply up.
  - rewrite finer_at, finer_before by lia. exact H1.
  - destruct (Nat.eq_dec i (S k)) as [->|N].
    + rewrite finer_at, finer_after by lia. lra.
    + destruct i as [|i]; [lia|]. rewrite !finer_after by lia. apply up.
Qed.

(** What function i of degree p is of functions i and i + 1 over the finer knots. *)
Definition first_part (p i : nat) : R :=
  if Nat.leb (S (i + p)) k then 1 else if Nat.ltb k i then 0 else quo (z - finer i) (finer (S (i + p)) - finer i).
Definition second_part (p i : nat) : R :=
  if Nat.leb (S (i + p)) k then 0 else if Nat.ltb k i then 1
  else quo (finer (S (S (i + p))) - z) (finer (S (S (i + p))) - finer (S i)).

Lemma parts_before p i : (S (i + p) <= k)%nat -> first_part p i = 1 /\ second_part p i = 0.
Proof. intro H. unfold first_part, second_part. now rewrite (proj2 (Nat.leb_le _ _) H). Qed.
Lemma parts_after p i : (k < i)%nat -> first_part p i = 0 /\ second_part p i = 1.
Proof.
  intro H. unfold first_part, second_part.
  now rewrite (proj2 (Nat.leb_gt (S (i + p)) k) ltac:(lia)), (proj2 (Nat.ltb_lt _ _) H).
Qed.
Lemma parts_inside p i : (i <= k < S (i + p))%nat -> first_part p i = quo (z - finer i) (finer (S (i + p)) - finer i) /\
  second_part p i = quo (finer (S (S (i + p))) - z) (finer (S (S (i + p))) - finer (S i)).
Proof.
  intro H. unfold first_part, second_part.
  now rewrite (proj2 (Nat.leb_gt (S (i + p)) k) ltac:(lia)), (proj2 (Nat.ltb_ge k i) ltac:(lia)).
Qed.

Lemma same_before p i x : (S (i + p) <= k)%nat -> N t p i x = N finer p i x.
Proof.
  intro H. unfold N. rewrite (cox_ext _ (fun j => inside (finer j) (finer (S j)) x)).
  - symmetry. apply cox_knots. intros j Hj. apply finer_before. lia.
  - intros j Hj. now rewrite !finer_before by lia.
Qed.

Lemma same_after p i x : (k < i)%nat -> N t p i x = N finer p (S i) x.
Proof.
  intro H. rewrite <- N_shift. unfold N, shift. rewrite (cox_ext _ (fun j => inside (finer (S j)) (finer (S (S j))) x)).
  - symmetry. apply cox_knots. intros j Hj. apply finer_after. lia.
  - intros j Hj. now rewrite !finer_after by lia.
Qed.

Lemma quo_0 a : quo a 0 = 0.
Proof. unfold quo. now destruct (Req_EM_T 0 0). Qed.

(** The three places of z in the step of the recursion; s and e are knots, x anywhere, A, B, C the functions below. *)
Lemma step_inside z' x s0 s1 s2 e0 e1 e2 A B C : e1 - s0 <> 0 -> e2 - s1 <> 0 ->
  (x - s0) / (e1 - s0) * (quo (z' - s0) (e0 - s0) * A + quo (e1 - z') (e1 - s1) * B)
  + (e2 - x) / (e2 - s1) * (quo (z' - s1) (e1 - s1) * B + quo (e2 - z') (e2 - s2) * C) =
  (z' - s0) / (e1 - s0) * (quo (x - s0) (e0 - s0) * A + quo (e1 - x) (e1 - s1) * B)
  + (e2 - z') / (e2 - s1) * (quo (x - s1) (e1 - s1) * B + quo (e2 - x) (e2 - s2) * C).
Proof.
  intros H1 H2. rewrite (quo_mult (z' - s0)), (quo_mult (e1 - z')), (quo_mult (z' - s1)), (quo_mult (e2 - z')),
    (quo_mult (x - s0)), (quo_mult (e1 - x)), (quo_mult (x - s1)), (quo_mult (e2 - x)).
  generalize (quo 1 (e0 - s0)) (quo 1 (e1 - s1)) (quo 1 (e2 - s2)). intros. field. split; assumption.
Qed.

Lemma step_at_the_end z' x s0 s1 s2 e0 e2 A B C : s0 <= s1 <= z' -> e0 <= z' -> s0 <= e0 -> z' < e2 ->
  quo (x - s0) (e0 - s0) * A + (e2 - x) / (e2 - s1) * (quo (z' - s1) (z' - s1) * B + quo (e2 - z') (e2 - s2) * C) =
  quo (z' - s0) (z' - s0) * (quo (x - s0) (e0 - s0) * A + quo (z' - x) (z' - s1) * B)
  + (e2 - z') / (e2 - s1) * (quo (x - s1) (z' - s1) * B + quo (e2 - x) (e2 - s2) * C).
Proof.
  intros H1 H2 H3 H4. rewrite (quo_mult (x - s0)), (quo_mult (e2 - z')), (quo_mult (e2 - x)).
  destruct (Req_dec z' s1) as [->|N1].
  - rewrite (Rminus_diag_eq s1 s1), !quo_0 by reflexivity. destruct (Req_dec s1 s0) as [->|N0].
    + rewrite (Rminus_diag_eq s0 s0), (Rminus_diag_eq e0 s0), !quo_0 by lra. field. lra.
    + rewrite (quo_div (s1 - s0) (s1 - s0)) by lra. field. split; lra.
  - rewrite !quo_div with (b := z' - s1) by lra. rewrite (quo_div (z' - s0) (z' - s0)) by lra. field. lra.
Qed.

Lemma step_at_the_start z' x s0 s2 e0 e1 e2 A B C : s0 < e1 -> z' < e1 -> z' < e2 ->
  (x - s0) / (e1 - s0) * (quo (z' - s0) (e0 - s0) * A + quo (e1 - z') (e1 - z') * B) + quo (e2 - x) (e2 - s2) * C =
  (z' - s0) / (e1 - s0) * (quo (x - s0) (e0 - s0) * A + quo (e1 - x) (e1 - z') * B)
  + quo (e2 - z') (e2 - z') * (quo (x - z') (e1 - z') * B + quo (e2 - x) (e2 - s2) * C).
Proof.
  intros H1 H2 H3. rewrite (quo_mult (z' - s0)), (quo_mult (x - s0)), (quo_mult (e2 - x)).
  rewrite !quo_div with (b := e1 - z') by lra. rewrite (quo_div (e2 - z') (e2 - z')) by lra. field. lra.
Qed.

Theorem insertion p : forall i x, N t p i x = first_part p i * N finer p i x + second_part p i * N finer p (S i) x.
Proof.
  destruct Hz as [Hz1 Hz2]. induction p as [|q IH]; intros i x.
  - destruct (lt_eq_lt_dec i k) as [[L | ->]|L].
    + destruct (parts_before 0 i ltac:(lia)) as [-> ->]. rewrite same_before by lia. ring.
    + destruct (parts_inside 0 k ltac:(lia)) as [-> ->]. rewrite Nat.add_0_r, finer_at, finer_before, finer_after by lia.
      unfold N. cbn [cox]. rewrite finer_at, finer_before, finer_after by lia. rewrite (quo_div (t (S k) - z)) by lra.
      unfold inside, quo. destruct (Req_EM_T (z - t k) 0), (Rle_dec (t k) x), (Rlt_dec x (t (S k))), (Rlt_dec x z),
        (Rle_dec z x); try lra; field; lra.
    + destruct (parts_after 0 i ltac:(lia)) as [-> ->]. rewrite same_after by lia. ring.
  - destruct (le_lt_dec (S (i + S q)) k) as [L|L].
    { destruct (parts_before (S q) i L) as [-> ->]. rewrite same_before by lia. ring. }
    destruct (le_lt_dec i k) as [Li|Li]; [|destruct (parts_after (S q) i Li) as [-> ->]; rewrite same_after by lia; ring].
    destruct (parts_inside (S q) i ltac:(lia)) as [-> ->].
    rewrite (N_step t), !(N_step finer), (IH i), (IH (S i)).
    replace (S (i + S q)) with (S i + S q)%nat by lia. replace (S (S i + S q)) with (S (S i) + S q)%nat by lia.
    pose proof (ascending_le t up i k Li) as Hs0. pose proof (finer_before i Li) as F0.
    destruct (Nat.eq_dec i k) as [->|Nk].
    + (* z comes right after the first knot. *)
      destruct (parts_inside q k ltac:(lia)) as [-> ->]. destruct (parts_after q (S k) ltac:(lia)) as [-> ->].
      rewrite Rmult_0_l, Rplus_0_l, Rmult_1_l.
      assert (F2 : finer (S (S k)) = t (S k)) by (apply finer_after; lia).
      assert (G1 : finer (S k + S q)%nat = t (k + S q)%nat).
      { replace (S k + S q)%nat with (S (k + S q)) by lia. apply finer_after. lia. }
      assert (G2 : finer (S (S k) + S q)%nat = t (S k + S q)%nat).
      { replace (S (S k) + S q)%nat with (S (S k + S q)) by lia. apply finer_after. lia. }
      replace (S (k + q)) with (k + S q)%nat by lia. replace (S (k + S q)) with (S k + S q)%nat by lia.
      rewrite finer_at, F0, F2, G1, G2.
      pose proof (ascending_le t up (S k) (k + S q) ltac:(lia)). pose proof (ascending_le t up (S k) (S k + S q) ltac:(lia)).
      rewrite (quo_div (x - t k) (t (k + S q)%nat - t k)), (quo_div (z - t k) (t (k + S q)%nat - t k)) by lra.
      apply step_at_the_start; lra.
    + assert (F1 : finer (S i) = t (S i)) by (apply finer_before; lia).
      pose proof (ascending_le t up (S i) k ltac:(lia)) as Hs1. pose proof (up i).
      destruct (Nat.eq_dec (i + S q) k) as [Ek|Nk'].
      * (* z comes right before the last knot. *)
        destruct (parts_before q i ltac:(lia)) as [-> ->]. destruct (parts_inside q (S i) ltac:(lia)) as [-> ->].
        rewrite Rmult_0_l, Rplus_0_r, Rmult_1_l.
        assert (G0 : finer (i + S q)%nat = t (i + S q)%nat) by (apply finer_before; lia).
        assert (G1 : finer (S i + S q)%nat = z) by (replace (S i + S q)%nat with (S k) by lia; apply finer_at).
        assert (G2 : finer (S (S i) + S q)%nat = t (S i + S q)%nat).
        { replace (S (S i) + S q)%nat with (S (S i + S q)) by lia. apply finer_after. lia. }
        replace (S (S i + q)) with (S i + S q)%nat by lia. replace (S (S i + S q)) with (S (S i) + S q)%nat by lia.
        rewrite F0, F1, G0, G1, G2.
        assert (T : t (S i + S q)%nat = t (S k)) by (f_equal; lia). rewrite T.
        rewrite (quo_div (t (S k) - x) (t (S k) - t (S i))), (quo_div (t (S k) - z) (t (S k) - t (S i))) by lra.
        pose proof (ascending_le t up i (i + S q) ltac:(lia)). rewrite Ek in *.
        apply step_at_the_end; lra.
      * (* z lies inside. *)
        destruct (parts_inside q i ltac:(lia)) as [-> ->]. destruct (parts_inside q (S i) ltac:(lia)) as [-> ->].
        assert (G1 : finer (S i + S q)%nat = t (i + S q)%nat).
        { replace (S i + S q)%nat with (S (i + S q)) by lia. apply finer_after. lia. }
        assert (G2 : finer (S (S i) + S q)%nat = t (S i + S q)%nat).
        { replace (S (S i) + S q)%nat with (S (S i + S q)) by lia. apply finer_after. lia. }
        replace (S (i + q)) with (i + S q)%nat by lia. replace (S (S i + q)) with (S i + S q)%nat by lia.
        replace (S (i + S q)) with (S i + S q)%nat by lia.
        replace (S (S i + S q)) with (S (S i) + S q)%nat by lia.
        rewrite F0, F1, G1, G2.
        pose proof (ascending_le t up (S k) (i + S q) ltac:(lia)). pose proof (ascending_le t up (S k) (S i + S q) ltac:(lia)).
        rewrite (quo_div (x - t i) (t (i + S q)%nat - t i)), (quo_div (z - t i) (t (i + S q)%nat - t i)),
          (quo_div (t (S i + S q)%nat - x) (t (S i + S q)%nat - t (S i))),
          (quo_div (t (S i + S q)%nat - z) (t (S i + S q)%nat - t (S i))) by lra.
        apply step_inside; lra.
Qed.

(** The control points over the finer knots. *)
Definition boehm (m p : nat) (P : nat -> R) (i : nat) : R :=
  (if Nat.leb i m then first_part p i * P i else 0)
  + match i with O => 0 | S l => second_part p l * P l end.

Theorem same_curve m p P x : spline (S m) finer p (boehm m p P) x = spline m t p P x.
Proof.
  unfold spline.
  rewrite (sum_ext (S m) _ (fun i => first_part p i * P i * N finer p i x + second_part p i * P i * N finer p (S i) x))
    by (intros; rewrite insertion; ring).
  rewrite sum_add.
  rewrite (sum_ext (S (S m)) _ (fun i => (if Nat.leb i m then first_part p i * P i else 0) * N finer p i x
    + match i with O => 0 | S l => second_part p l * P l end * N finer p i x)) by (intros; unfold boehm; ring).
  rewrite sum_add. f_equal.
  - cbn [sum]. rewrite (proj2 (Nat.leb_gt (S m) m) ltac:(lia)), (proj2 (Nat.leb_le m m) ltac:(lia)).
    rewrite (sum_ext m _ (fun i => first_part p i * P i * N finer p i x)); [ring|].
    intros i Hi. now rewrite (proj2 (Nat.leb_le i m) ltac:(lia)).
  - rewrite sum_first. ring.
Qed.
End Insertion.
