(** What generated bounds over a box are closed by: sums of squares, and the box as a square of side 2. *)
From Coq Require Export Reals Lra.
Open Scope R_scope.

Lemma within c r x : 0 < r -> c - r <= x <= c + r -> 0 <= 1 - ((x - c) / r) ^ 2.
Proof.
  intros Hr H. set (s := (x - c) / r). assert (E : s * r = x - c) by (unfold s; field; lra).
  assert (-1 <= s <= 1) by (split; apply (Rmult_le_reg_r r); lra). nra.
Qed.

(** f - bound = A + (1 - s^2) B + (1 - t^2) C, all of which are sums of squares with positive factors. *)
Lemma by_squares a b c s t : 0 <= a -> 0 <= b -> 0 <= c -> 0 <= 1 - s ^ 2 -> 0 <= 1 - t ^ 2 ->
  0 <= a + (1 - s ^ 2) * b + (1 - t ^ 2) * c.
Proof. intros. repeat apply Rplus_le_le_0_compat; [assumption|now apply Rmult_le_pos..]. Qed.

Ltac squares := repeat apply Rplus_le_le_0_compat; (apply Rmult_le_pos; [apply (IZR_le 0); discriminate | apply pow2_ge_0]).
