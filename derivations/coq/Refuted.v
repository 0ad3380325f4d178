(** Statements with one change each, refuted: that their scripts no longer run would prove nothing. *)
From Coq Require Import Reals Lra Lia List.
From Semispline Require Import Sums BSplines Derivatives Division Printed.
Import ListNotations.
Open Scope R_scope.

Lemma INR_ascending : ascending INR.
Proof. intro i. rewrite S_INR. lra. Qed.

(** Support, without ascending knots. *)
Theorem support_needs_order : ~ forall t p i x, x < t i \/ t (S (i + p)) <= x -> N t p i x = 0.
Proof.
  intro H. specialize (H (vector [0; 3; 1]) 1%nat 0%nat 2 ltac:(cbn; lra)). unfold N in H. cbn in H.
  rewrite (inside_1 0 3 2), (inside_0 3 1 2), !quo_div in H by lra. lra.
Qed.

(** Partition of unity, from the first knot on. *)
Theorem unity_needs_the_domain : ~ forall t p m x, ascending t -> (p <= m)%nat -> t O <= x < t (S m) ->
  sum (S m) (fun i => N t p i x) = 1.
Proof.
  intro H. specialize (H INR 1%nat 1%nat (1/2) INR_ascending (le_n 1) ltac:(cbn; lra)). unfold N in H. cbn in H.
  rewrite (inside_1 0 1), (inside_0 1 (1 + 1)), (inside_0 (1 + 1) (1 + 1 + 1)), !quo_div in H by lra. lra.
Qed.

(** The derivative formula, with p - 1 for p. *)
Theorem derivative_needs_its_factor : ~ forall d t q i x, ascending t -> derivable_pt_lim (cox d t (S q) i) x
  (INR q * (quo (cox d t q i x) (t (i + S q)%nat - t i) - quo (cox d t q (S i) x) (t (S i + S q)%nat - t (S i)))).
Proof.
  intro H. pose proof (H (delta 0) INR O O 0 INR_ascending) as A.
  pose proof (cox_derivative (delta 0) INR INR_ascending O O 0) as B.
  pose proof (uniqueness_limite _ _ _ _ A B) as E. unfold delta in E. cbn in E. rewrite !quo_div in E by lra. lra.
Qed.

(** The lower part of a curve, with its arguments in the upper one's order. *)
Theorem lower_part_needs_its_order : ~ forall n c P y,
  bezier n P (c * y) = bezier n (fun s => blossom (repeat c (n - s)) P s) y.
Proof.
  intro H. specialize (H 1%nat (1/2) INR 0). unfold bezier, bern in H. cbn in H.
  rewrite !C_first, !C_last in H. lra.
Qed.
