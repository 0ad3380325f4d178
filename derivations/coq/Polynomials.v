(** Polynomials with too many zeros, and splines that agree at enough points of a span. *)
From Coq Require Import Reals Lra Lia List.
From Semispline Require Import Sums BSplines Derivatives.
Import ListNotations.
Open Scope R_scope.

(** Polynomials with n coefficients. *)
Definition polynomial (n : nat) (f : R -> R) : Prop := exists c : nat -> R, forall x, f x = sum n (fun i => c i * x ^ i).

Lemma polynomial_ext n f g : (forall x, f x = g x) -> polynomial n f -> polynomial n g.
Proof. intros E [c H]. exists c. intro x. now rewrite <- E. Qed.

Lemma polynomial_more n f : polynomial n f -> polynomial (S n) f.
Proof.
  intros [c H]. exists (fun i => if Nat.ltb i n then c i else 0). intro x. cbn [sum]. rewrite Nat.ltb_irrefl, H.
  rewrite Rmult_0_l, Rplus_0_r. apply sum_ext. intros i Hi. now rewrite (proj2 (Nat.ltb_lt i n) Hi).
Qed.

Lemma polynomial_sum n f g a b : polynomial n f -> polynomial n g -> polynomial n (fun x => a * f x + b * g x).
Proof.
  intros [c H] [d K]. exists (fun i => a * c i + b * d i). intro x. rewrite H, K, <- !sum_scale, <- sum_add.
  apply sum_ext. intros. ring.
Qed.

Lemma polynomial_shift n f : polynomial n f -> polynomial (S n) (fun x => x * f x).
Proof.
  intros [c H]. exists (fun i => match i with O => 0 | S j => c j end). intro x.
  rewrite sum_first, H, <- sum_scale. cbn [pow]. rewrite Rmult_0_l, Rplus_0_l. apply sum_ext. intros. ring.
Qed.

Lemma polynomial_linear n f a b : polynomial n f -> polynomial (S n) (fun x => (a + b * x) * f x).
Proof.
  intro H. apply (polynomial_ext _ (fun x => a * f x + b * (x * f x))); [intro; ring|].
  apply polynomial_sum; [now apply polynomial_more|now apply polynomial_shift].
Qed.

(** The value at r, and a factor x - r of the rest. *)
Lemma divided n : forall f r, polynomial (S n) f -> exists g, polynomial n g /\ forall x, f x = f r + (x - r) * g x.
Proof.
  induction n as [|n IH]; intros f r [c H].
  - exists (fun _ => 0). split; [now exists c|]. intro x. rewrite !H. cbn. ring.
  - assert (F : exists h, polynomial (S n) h /\ forall x, f x = c O + x * h x).
    { exists (fun x => sum (S n) (fun i => c (S i) * x ^ i)). split; [now exists (fun i => c (S i))|].
      intro x. rewrite H, sum_first, <- (sum_scale (S n) x). cbn [pow]. f_equal; [ring|].
      apply sum_ext. intros. ring. }
    destruct F as (h & Hh & F). destruct (IH h r Hh) as (g & Hg & E). exists (fun x => h r + x * g x). split.
    + apply (polynomial_ext _ (fun x => 1 * h r + 1 * (x * g x))); [intro; ring|].
      apply polynomial_sum; [|now apply polynomial_shift]. exists (fun i => match i with O => h r | _ => 0 end).
      intro x. rewrite sum_first, sum_zero by (intros; ring). cbn [pow]. ring.
    + intro x. rewrite (F x), (F r), (E x). ring.
Qed.

Theorem too_many_zeros n : forall f zeros, polynomial n f -> NoDup zeros -> length zeros = n ->
  (forall x, In x zeros -> f x = 0) -> forall x, f x = 0.
Proof.
  induction n as [|n IH]; intros f zeros Hf Hd Hl Hz x.
  - destruct Hf as [c H]. rewrite H. reflexivity.
  - destruct zeros as [|r rest]; [discriminate|]. destruct (divided n f r Hf) as (g & Hg & E).
    inversion Hd as [|? ? Nr Nd]; subst. rewrite E, (Hz r) by now left.
    rewrite (IH g rest Hg Nd); [ring|now injection Hl|]. intros y Hy.
    pose proof (Hz y (or_intror Hy)) as Z. rewrite E, (Hz r) in Z by now left.
    assert (y <> r) by (intros ->; contradiction). apply (Rmult_eq_reg_l (y - r)); lra.
Qed.

(** Pieces of a spline of degree p are polynomials with p + 1 coefficients. *)
Lemma cox_polynomial d t p : forall i, polynomial (S p) (cox d t p i).
Proof.
  induction p as [|q IH]; intro i.
  - exists (fun _ => d i). intro x. cbn. ring.
  - apply (polynomial_ext _ (fun x => 1 * ((- t i * quo 1 (t (i + S q)%nat - t i) + quo 1 (t (i + S q)%nat - t i) * x)
        * cox d t q i x)
      + 1 * ((t (S i + S q)%nat * quo 1 (t (S i + S q)%nat - t (S i)) + - quo 1 (t (S i + S q)%nat - t (S i)) * x)
        * cox d t q (S i) x))).
    + intro x. rewrite cox_step. ring.
    + apply polynomial_sum; apply polynomial_linear, IH.
Qed.

Lemma piece_polynomial k m t p P : polynomial (S p) (piece k m t p P).
Proof.
  unfold piece. induction (S m) as [|n IH].
  - exists (fun _ => 0). intro x. symmetry. apply (sum_zero (S p)). intros. ring.
  - apply (polynomial_ext _ (fun x => 1 * sum n (fun i => P i * cox (delta k) t p i x) + P n * cox (delta k) t p n x)).
    + intro x. cbn [sum]. ring.
    + apply polynomial_sum; [exact IH|apply cox_polynomial].
Qed.

(** Splines over whatever knots that agree at p + 1 points of a span agree on it. *)
Theorem same_on_span t s p m m' P Q k l points : ascending t -> ascending s -> NoDup points ->
  length points = S p -> (forall x, In x points -> span t k x /\ span s l x) ->
  (forall x, In x points -> spline m t p P x = spline m' s p Q x) ->
  forall x, span t k x -> span s l x -> spline m t p P x = spline m' s p Q x.
Proof.
  intros up us Hd Hl Hin He x Ht Hs. rewrite (spline_piece t k), (spline_piece s l) by assumption.
  apply Rminus_diag_uniq.
  apply (too_many_zeros (S p) (fun y => piece k m t p P y - piece l m' s p Q y) points); auto.
  - apply (polynomial_ext _ (fun y => 1 * piece k m t p P y + -1 * piece l m' s p Q y)); [intro; ring|].
    apply polynomial_sum; apply piece_polynomial.
  - intros y Hy. destruct (Hin y Hy) as [H1 H2]. rewrite <- (spline_piece t k), <- (spline_piece s l), He by assumption.
    ring.
Qed.
