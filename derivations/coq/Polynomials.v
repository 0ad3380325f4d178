(** Polynomials with too many zeros, and splines that agree at enough points of a span. *)
From Coq Require Import Reals Lra Lia List FinFun.
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

(** A polynomial that stays bounded is constant; so none runs along a circle. *)
Theorem bounded_is_constant n : forall f M, polynomial n f -> (forall x, 1 <= x -> Rabs (f x) <= M) -> forall x, f x = f 0.
Proof.
  induction n as [|n IH]; intros f M Hf HM x.
  - destruct Hf as [c H]. now rewrite !H.
  - destruct (divided n f 0 Hf) as (g & Hg & E). set (K := M + Rabs (f 0)).
    assert (G : forall y, 1 <= y -> y * Rabs (g y) <= K).
    { intros y Hy. specialize (HM y Hy). rewrite <- (Rabs_right y) at 1 by lra. rewrite <- Rabs_mult.
      replace (y * g y) with (f y + - f 0) by (rewrite (E y); ring).
      pose proof (Rabs_triang (f y) (- f 0)). rewrite Rabs_Ropp in *. unfold K. lra. }
    assert (C : forall y, g y = g 0).
    { apply (IH g K Hg). intros y Hy. specialize (G y Hy). pose proof (Rabs_pos (g y)). nra. }
    assert (Z : g 0 = 0).
    { destruct (Req_dec (g 0) 0) as [|N]; [assumption|exfalso]. pose proof (Rabs_pos_lt _ N) as P.
      assert (HK : 0 <= K) by (specialize (G 1 (Rle_refl 1)); rewrite C in G; lra).
      specialize (G (1 + K / Rabs (g 0))). rewrite (C (1 + _)) in G.
      assert (0 <= K / Rabs (g 0)) by (apply Rmult_le_pos; [lra|left; now apply Rinv_0_lt_compat]).
      specialize (G ltac:(lra)). replace ((1 + K / Rabs (g 0)) * Rabs (g 0)) with (Rabs (g 0) + K) in G by (field; lra).
      lra. }
    rewrite (E x), C, Z. ring.
Qed.

Theorem none_on_a_circle n x y r : polynomial n x -> polynomial n y -> (forall t, x t ^ 2 + y t ^ 2 = r ^ 2) ->
  forall t, x t = x 0 /\ y t = y 0.
Proof.
  intros Hx Hy H t.
  assert (B : forall a b, a ^ 2 + b ^ 2 = r ^ 2 -> Rabs a <= Rabs r).
  { intros a b E. apply Rsqr_le_abs_0. unfold Rsqr. nra. }
  split; [apply (bounded_is_constant n x (Rabs r) Hx)|apply (bounded_is_constant n y (Rabs r) Hy)]; intros s _.
  - now apply (B _ (y s)).
  - apply (B _ (x s)). rewrite <- (H s). ring.
Qed.

(** No quotient of polynomials solves y'' = -y: it would be a cos x + b sin x, with zeros without end. *)
Lemma constant_right_of a f : (forall x, a < x -> derivable_pt_lim f x 0) -> forall x y, a < x -> x < y -> f x = f y.
Proof.
  intros D x y Hx Hxy. symmetry.
  apply (null_derivative_loc f x y (fun z Hz => exist _ 0 (D z (Rlt_trans _ _ _ Hx (proj1 Hz))))).
  - intros z Hz. apply derivable_continuous_pt. exists 0. apply D. lra.
  - reflexivity.
  - lra.
Qed.

Theorem no_rational_solution n p q y y1 a : polynomial n p -> (forall x, a < x -> q x <> 0) ->
  (forall x, a < x -> y x = p x / q x) -> (forall x, a < x -> derivable_pt_lim y x (y1 x)) ->
  (forall x, a < x -> derivable_pt_lim y1 x (- y x)) -> forall x, p x = 0.
Proof.
  intros Hp Hq Hy D D1.
  set (w1 := fun x => y x * cos x - y1 x * sin x). set (w2 := fun x => y x * sin x + y1 x * cos x).
  assert (C1 : forall x, a < x -> derivable_pt_lim w1 x 0).
  { intros x Hx. replace 0 with (y1 x * cos x + y x * - sin x - (- y x * sin x + y1 x * cos x)) by ring.
    apply (derivable_pt_lim_minus (fun z => y z * cos z) (fun z => y1 z * sin z)).
    - apply (derivable_pt_lim_mult y cos); [now apply D|apply derivable_pt_lim_cos].
    - apply (derivable_pt_lim_mult y1 sin); [now apply D1|apply derivable_pt_lim_sin]. }
  assert (C2 : forall x, a < x -> derivable_pt_lim w2 x 0).
  { intros x Hx. replace 0 with (y1 x * sin x + y x * cos x + (- y x * cos x + y1 x * - sin x)) by ring.
    apply (derivable_pt_lim_plus (fun z => y z * sin z) (fun z => y1 z * cos z)).
    - apply (derivable_pt_lim_mult y sin); [now apply D|apply derivable_pt_lim_sin].
    - apply (derivable_pt_lim_mult y1 cos); [now apply D1|apply derivable_pt_lim_cos]. }
  set (x0 := a + 1). set (A := w1 x0). set (B := w2 x0). set (h := fun x => A * cos x + B * sin x).
  assert (E : forall x, x0 < x -> y x = h x).
  { intros x Hx. unfold h, A, B. rewrite (constant_right_of a w1 C1 x0 x), (constant_right_of a w2 C2 x0 x)
      by (unfold x0 in *; lra). unfold w1, w2. pose proof (sin2_cos2 x) as S. unfold Rsqr in S.
    transitivity (y x * (sin x * sin x + cos x * cos x)); [rewrite S|]; ring. }
  assert (Turn : forall x, h (x + PI) = - h x).
  { intro x. unfold h. rewrite neg_cos, neg_sin. ring. }
  assert (Ch : continuity h).
  { intro x. apply (continuity_pt_plus (fun z => A * cos z) (fun z => B * sin z)).
    - apply (continuity_pt_scal cos), continuity_cos.
    - apply (continuity_pt_scal sin), continuity_sin. }
  pose proof PI_RGT_0 as Pi.
  destruct (IVT_cor h (x0 + 1) (x0 + 1 + PI) Ch) as (s & Hs & Zs); [lra|rewrite Turn; nra|].
  assert (Zeros : forall k, h (s + INR k * PI) = 0).
  { induction k as [|k IHk]; [cbn [INR]; rewrite Rmult_0_l, Rplus_0_r; exact Zs|].
    rewrite S_INR. replace (s + (INR k + 1) * PI) with (s + INR k * PI + PI) by ring. rewrite Turn, IHk. ring. }
  apply (too_many_zeros n p (map (fun k => s + INR k * PI) (seq 0 n)) Hp).
  - apply Injective_map_NoDup; [|apply seq_NoDup]. intros k l Ekl. apply INR_eq.
    apply (Rmult_eq_reg_r PI); lra.
  - now rewrite map_length, seq_length.
  - intros x Hx. apply in_map_iff in Hx. destruct Hx as (k & <- & _).
    assert (P : 0 <= INR k * PI) by (apply Rmult_le_pos; [apply pos_INR|lra]).
    assert (L : x0 < s + INR k * PI) by lra. assert (La : a < s + INR k * PI) by (unfold x0 in L; lra).
    pose proof (E _ L) as Ey. rewrite (Zeros k), (Hy _ La) in Ey.
    apply (Rmult_eq_reg_r (/ q (s + INR k * PI))); [|apply Rinv_neq_0_compat, Hq; exact La].
    rewrite Rmult_0_l. exact Ey.
Qed.
