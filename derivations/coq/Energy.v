(** What the energy (11) and its minimum rest on: integrals, quadratic forms, and the cubic as least curve. *)
From Coq Require Import Reals Lra Lia Ranalysis5.
From Semispline Require Import Sums BSplines Derivatives.
Open Scope R_scope.

Lemma newton_leibniz f F a b (pr : Riemann_integrable f a b) : a <= b ->
  (forall x, a <= x <= b -> continuity_pt f x) -> (forall x, a <= x <= b -> derivable_pt_lim F x (f x)) ->
  RiemannInt pr = F b - F a.
Proof.
  intros h C D. rewrite (RiemannInt_P20 h (FTC_P1 h C) pr).
  destruct (antiderivative_Ucte f (primitive h (FTC_P1 h C)) F a b (RiemannInt_P29 h C)) as (c & E).
  - split; [|exact h]. intros x Hx. exists (exist _ (f x) (D x Hx)). reflexivity.
  - rewrite !E by lra. ring.
Qed.

Lemma integral_nonneg f a b (pr : Riemann_integrable f a b) : a <= b -> (forall x, a < x < b -> 0 <= f x) ->
  0 <= RiemannInt pr.
Proof.
  intros h H. replace 0 with (RiemannInt (RiemannInt_P14 a b 0)) by (rewrite RiemannInt_P15; ring).
  now apply RiemannInt_P19.
Qed.

(** The integral of a square vanishes only where the function does. *)
Theorem zero_energy f a b (pr : Riemann_integrable (fun x => f x * f x) a b) : a < b ->
  (forall x, a <= x <= b -> continuity_pt f x) -> RiemannInt pr = 0 -> forall x, a < x < b -> f x = 0.
Proof.
  intros h C Z x Hx. set (s := fun x => f x * f x) in *.
  assert (Cs : forall y, a <= y <= b -> continuity_pt s y) by (intros y Hy; now apply (continuity_pt_mult f f); apply C).
  assert (h' : a <= b) by lra. set (F := primitive h' (FTC_P1 h' Cs)).
  assert (F0 : forall y, a < y < b -> F y = 0).
  { intros y Hy. unfold F, primitive. destruct (Rle_dec a y) as [Ha|]; [|lra]. destruct (Rle_dec y b) as [Hb|]; [|lra].
    assert (Rest : Riemann_integrable s y b) by (apply continuity_implies_RiemannInt; [lra|intros; apply Cs; lra]).
    pose proof (RiemannInt_P26 (FTC_P1 h' Cs Ha Hb) Rest pr) as S. rewrite Z in S.
    assert (0 <= RiemannInt (FTC_P1 h' Cs Ha Hb)) by (apply integral_nonneg; [lra|intros; apply Rle_0_sqr]).
    assert (0 <= RiemannInt Rest) by (apply integral_nonneg; [lra|intros; apply Rle_0_sqr]). lra. }
  pose proof (RiemannInt_P28 h' Cs (conj (Rlt_le _ _ (proj1 Hx)) (Rlt_le _ _ (proj2 Hx)))) as D.
  apply (derivable_pt_lim_locally_ext F (fct_cte 0) x a b _ Hx) in D; [|exact F0].
  pose proof (uniqueness_limite _ _ _ _ D (derivable_pt_lim_const 0 x)) as E. now apply Rsqr_0_uniq.
Qed.

(** The integral of a function of u times one of v is a product of integrals. *)
Lemma scaled_integrable f k a b : Riemann_integrable f a b -> Riemann_integrable (fun x => k * f x) a b.
Proof.
  intro pr. apply (Riemann_integrable_ext (f := fun x => fct_cte 0 x + k * f x)).
  - intros. unfold fct_cte. ring.
  - apply RiemannInt_P10; [apply RiemannInt_P14|exact pr].
Qed.

Lemma scaled_integral f k a b (pr : Riemann_integrable f a b) (pr' : Riemann_integrable (fun x => k * f x) a b) :
  a <= b -> RiemannInt pr' = k * RiemannInt pr.
Proof.
  intro h. set (z := RiemannInt_P14 a b 0).
  transitivity (RiemannInt (RiemannInt_P10 k z pr)).
  - apply RiemannInt_P18; [exact h|]. intros. unfold fct_cte. ring.
  - rewrite (RiemannInt_P13 z pr), RiemannInt_P15. ring.
Qed.

Theorem product_of_integrals f g a b c d (pf : Riemann_integrable f a b) (pg : Riemann_integrable g c d) :
  a <= b -> c <= d -> exists (inner : forall v, Riemann_integrable (fun u => g v * f u) a b)
    (outer : Riemann_integrable (fun v => RiemannInt (inner v)) c d), RiemannInt outer = RiemannInt pf * RiemannInt pg.
Proof.
  intros h h'. exists (fun v => scaled_integrable f (g v) a b pf).
  assert (E : forall v, RiemannInt pf * g v = RiemannInt (scaled_integrable f (g v) a b pf)).
  { intro v. rewrite (scaled_integral f (g v) a b pf _ h). ring. }
  exists (Riemann_integrable_ext _ (fun v _ => E v) (scaled_integrable g (RiemannInt pf) c d pg)).
  rewrite <- (scaled_integral g (RiemannInt pf) c d pg (scaled_integrable g (RiemannInt pf) c d pg) h').
  apply RiemannInt_P18; [exact h'|]. intros. now rewrite <- E.
Qed.

(** A quadratic energy in n unknowns: half its slope, and where it is least. *)
Section Quadratic.
Variables (n : nat) (A : nat -> nat -> R) (b : nat -> R).
Hypothesis symmetric : forall i j, A i j = A j i.
Definition bilinear (x y : nat -> R) := sum n (fun i => sum n (fun j => A i j * x i * y j)).
Definition energy x := bilinear x x + 2 * sum n (fun i => b i * x i).
(** Row i of the normal equation. *)
Definition row x i := sum n (fun j => A i j * x j) + b i.

Lemma bilinear_rows d x : bilinear d x = sum n (fun i => d i * sum n (fun j => A i j * x j)).
Proof. apply sum_ext. intros i _. rewrite <- sum_scale. apply sum_ext. intros. ring. Qed.

Lemma bilinear_symmetric x y : bilinear x y = bilinear y x.
Proof.
  unfold bilinear. rewrite sum_swap. apply sum_ext. intros i _. apply sum_ext. intros j _. rewrite (symmetric j i). ring.
Qed.

Theorem expansion x d : energy (fun i => x i + d i) = energy x + 2 * sum n (fun i => d i * row x i) + bilinear d d.
Proof.
  assert (E : bilinear (fun i => x i + d i) (fun i => x i + d i)
    = bilinear x x + bilinear x d + (bilinear d x + bilinear d d)).
  { unfold bilinear. rewrite <- !sum_add. apply sum_ext. intros i _. rewrite <- !sum_add. apply sum_ext. intros. ring. }
  unfold energy. rewrite E, (bilinear_symmetric x d), (bilinear_rows d x).
  rewrite (sum_ext n (fun i => b i * (x i + d i)) (fun i => b i * x i + d i * b i)) by (intros; ring).
  rewrite (sum_ext n (fun i => d i * row x i) (fun i => d i * sum n (fun j => A i j * x j) + d i * b i))
    by (intros; unfold row; ring).
  rewrite !sum_add. ring.
Qed.

Definition bump r e i : R := if Nat.eq_dec i r then e else 0.
Lemma sum_bump r e f : (r < n)%nat -> sum n (fun i => bump r e i * f i) = e * f r.
Proof.
  intro H. rewrite (sum_single n r); [|exact H|].
  - unfold bump. now destruct (Nat.eq_dec r r).
  - intros i _ N. unfold bump. destruct (Nat.eq_dec i r); [contradiction|ring].
Qed.

(** For every number of unknowns: the slope in unknown r is twice its row. *)
Theorem half_slope x r e : (r < n)%nat -> e <> 0 ->
  (energy (fun i => x i + bump r e i) - energy (fun i => x i + bump r (- e) i)) / (4 * e) = row x r.
Proof.
  intros H He. rewrite !expansion, !sum_bump by exact H.
  assert (E : bilinear (bump r (- e)) (bump r (- e)) = bilinear (bump r e) (bump r e)).
  { unfold bilinear. apply sum_ext. intros i _. apply sum_ext. intros j _. unfold bump.
    destruct (Nat.eq_dec i r), (Nat.eq_dec j r); ring. }
  rewrite E. field. exact He.
Qed.

(** Least at the solution of the normal equation, if no direction has negative energy. *)
Theorem least_energy x : (forall d, 0 <= bilinear d d) -> (forall i, (i < n)%nat -> row x i = 0) ->
  forall d, energy x <= energy (fun i => x i + d i).
Proof.
  intros P Z d. rewrite expansion, (sum_zero n (fun i => d i * row x i)); [specialize (P d); lra|].
  intros i Hi. rewrite Z by exact Hi. ring.
Qed.
End Quadratic.

(** Of all curves with given values and slopes at both ends the cubic has the least energy: by parts, since H'''' = 0. *)
Theorem cubic_is_least (f f1 f2 : R -> R) l c0 c1 c2 c3 : 0 < l ->
  let H x := c0 + c1 * x + c2 * x ^ 2 + c3 * x ^ 3 in let H1 x := c1 + 2 * c2 * x + 3 * c3 * x ^ 2 in
  let H2 x := 2 * c2 + 6 * c3 * x in
  (forall x, derivable_pt_lim f x (f1 x)) -> (forall x, derivable_pt_lim f1 x (f2 x)) -> continuity f2 ->
  f 0 = H 0 -> f l = H l -> f1 0 = H1 0 -> f1 l = H1 l ->
  forall (pf : Riemann_integrable (fun x => f2 x * f2 x) 0 l) (pH : Riemann_integrable (fun x => H2 x * H2 x) 0 l),
    RiemannInt pH <= RiemannInt pf.
Proof.
  intros Hl H H1 H2 Df Df1 Cf E0 E1 E2 E3 pf pH.
  assert (D : forall x, derivable_pt_lim H x (H1 x)).
  { intro x. apply (derivable_value _ _ (0 + c1 * 1 + c2 * (2 * x ^ 1) + c3 * (3 * x ^ 2))); [|unfold H1; ring].
    repeat apply (derivable_pt_lim_plus (fun y => _) (fun y => _)).
    - apply derivable_pt_lim_const.
    - apply (derivable_pt_lim_scal id), derivable_pt_lim_id.
    - apply (derivable_pt_lim_scal (fun y => y ^ 2)). exact (derivable_pt_lim_pow x 2).
    - apply (derivable_pt_lim_scal (fun y => y ^ 3)). replace 3 with (INR 3) by (cbn; ring).
      exact (derivable_pt_lim_pow x 3). }
  assert (D1 : forall x, derivable_pt_lim H1 x (H2 x)).
  { intro x. apply (derivable_value _ _ (0 + 2 * c2 * 1 + 3 * c3 * (2 * x ^ 1))); [|unfold H2; ring].
    repeat apply (derivable_pt_lim_plus (fun y => _) (fun y => _)).
    - apply derivable_pt_lim_const.
    - apply (derivable_pt_lim_scal id), derivable_pt_lim_id.
    - apply (derivable_pt_lim_scal (fun y => y ^ 2)). exact (derivable_pt_lim_pow x 2). }
  assert (D2 : forall x, derivable_pt_lim H2 x (6 * c3)).
  { intro x. apply (derivable_value _ _ (0 + 6 * c3 * 1)); [|ring].
    apply (derivable_pt_lim_plus (fun _ => 2 * c2) (fun y => 6 * c3 * y)); [apply derivable_pt_lim_const|].
    apply (derivable_pt_lim_scal id), derivable_pt_lim_id. }
  set (g := fun x => f x - H x). set (g1 := fun x => f1 x - H1 x). set (g2 := fun x => f2 x - H2 x).
  assert (CH : continuity H2) by (intro x; apply derivable_continuous_pt; exists (6 * c3); apply D2).
  assert (Cg : continuity g2) by (apply (continuity_minus f2 H2); assumption).
  assert (pg : Riemann_integrable (fun x => H2 x * g2 x) 0 l).
  { apply continuity_implies_RiemannInt; [lra|]. intros x _. now apply (continuity_pt_mult H2 g2). }
  assert (pgg : Riemann_integrable (fun x => g2 x * g2 x) 0 l).
  { apply continuity_implies_RiemannInt; [lra|]. intros x _. now apply (continuity_pt_mult g2 g2). }
  (* H'' g' - H''' g has the derivative H'' g'', and vanishes at both ends. *)
  assert (Z : RiemannInt pg = 0).
  { rewrite (newton_leibniz _ (fun x => H2 x * g1 x - 6 * c3 * g x) 0 l pg); [|lra| |].
    - unfold g, g1. rewrite E0, E1, E2, E3. ring.
    - intros x _. now apply (continuity_pt_mult H2 g2).
    - intros x _. replace (H2 x * g2 x) with (6 * c3 * g1 x + H2 x * g2 x - 6 * c3 * g1 x) by ring.
      apply (derivable_pt_lim_minus (fun y => H2 y * g1 y) (fun y => 6 * c3 * g y)).
      + apply (derivable_pt_lim_mult H2 g1); [apply D2|]. apply (derivable_pt_lim_minus f1 H1); [apply Df1|apply D1].
      + apply (derivable_pt_lim_scal g). apply (derivable_pt_lim_minus f H); [apply Df|apply D]. }
  set (p1 := RiemannInt_P10 2 pH pg). set (p2 := RiemannInt_P10 1 p1 pgg).
  assert (E : RiemannInt pf = RiemannInt p2).
  { apply RiemannInt_P18; [lra|]. intros x _. unfold g2. ring. }
  rewrite E. unfold p2. rewrite (RiemannInt_P13 p1 pgg). unfold p1. rewrite (RiemannInt_P13 pH pg), Z.
  assert (0 <= RiemannInt pgg) by (apply integral_nonneg; [lra|intros; apply Rle_0_sqr]). lra.
Qed.

(** A derivative takes one power of x away from x^n g: those up to order n - 1 vanish at 0. *)
Theorem powers_taken_away n : forall G : nat -> R -> R, (forall k x, derivable_pt_lim (G k) x (G (S k) x)) ->
  exists H : nat -> R -> R, (forall x, H O x = x ^ n * G O x) /\ (forall k x, derivable_pt_lim (H k) x (H (S k) x)) /\
    forall k, (k < n)%nat -> H k 0 = 0.
Proof.
  induction n as [|n IH]; intros G D.
  - exists G. repeat split; [intro; cbn; ring|exact D|lia].
  - set (G1 := fun k x => (INR (S n) + INR k) * G k x + x * G (S k) x).
    destruct (IH G1) as (H & E & DH & Z).
    { intros k x. unfold G1. replace ((INR (S n) + INR (S k)) * G (S k) x + x * G (S (S k)) x)
        with ((INR (S n) + INR k) * G (S k) x + (1 * G (S k) x + x * G (S (S k)) x)) by (rewrite (S_INR k); ring).
      apply (derivable_pt_lim_plus (fun y => (INR (S n) + INR k) * G k y) (fun y => y * G (S k) y)).
      - apply (derivable_pt_lim_scal (G k)), D.
      - apply (derivable_pt_lim_mult id (G (S k))); [apply derivable_pt_lim_id|apply D]. }
    exists (fun k => match k with O => fun x => x ^ S n * G O x | S j => H j end). repeat split.
    + intros [|k] x; [|apply DH]. rewrite E. unfold G1.
      replace (x ^ n * ((INR (S n) + INR 0) * G O x + x * G 1%nat x))
        with (INR (S n) * x ^ n * G O x + x ^ S n * G 1%nat x) by (cbn [INR pow]; ring).
      apply (derivable_pt_lim_mult (fun y => y ^ S n) (G O)); [exact (derivable_pt_lim_pow x (S n))|apply D].
    + intros [|k] Hk; [cbn; ring|]. apply Z. lia.
Qed.

(** A limit of slopes that are not positive is not. *)
Theorem slope_not_positive f x l : derivable_pt_lim f x l -> (exists d, 0 < d /\ forall h, 0 < h < d -> f (x + h) <= f x) ->
  l <= 0.
Proof.
  intros D (d & Hd & Hf). destruct (Rle_dec l 0); [assumption|]. exfalso.
  destruct (D l ltac:(lra)) as [e He]. set (h := Rmin d e / 2).
  pose proof (Rmin_l d e). pose proof (Rmin_r d e). assert (0 < Rmin d e) by (apply Rmin_pos; [lra|apply cond_pos]).
  specialize (Hf h ltac:(unfold h; lra)). specialize (He h ltac:(unfold h; lra)).
  rewrite Rabs_right in He by (unfold h; lra). specialize (He ltac:(unfold h; lra)).
  apply Rabs_def2 in He. destruct He as [_ He].
  assert (K : (f (x + h) - f x) / h <= 0); [|lra].
  apply (Rmult_le_reg_l h); [unfold h; lra|]. field_simplify; [lra|unfold h; lra].
Qed.

(** ((t + g) / g)^p has the slope p / g where t is 0. *)
Theorem slope_of_power g p : g <> 0 -> derivable_pt_lim (fun t => ((t + g) / g) ^ p) 0 (INR p / g).
Proof.
  intro Hg. induction p as [|p IH].
  - cbn. replace (0 / g) with 0 by (field; exact Hg). apply derivable_pt_lim_const.
  - replace (INR (S p) / g) with (1 * / g * ((0 + g) / g) ^ p + (0 + g) / g * (INR p / g)).
    + apply (derivable_pt_lim_mult (fun t => (t + g) / g) (fun t => ((t + g) / g) ^ p)); [|exact IH].
      replace (1 * / g) with ((1 + 0) * / g + (0 + g) * 0) by ring.
      apply (derivable_pt_lim_mult (fun t => t + g) (fun _ => / g)); [|apply derivable_pt_lim_const].
      apply (derivable_pt_lim_plus id (fun _ => g)); [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
    + rewrite Rplus_0_l. replace (g / g) with 1 by (field; exact Hg). rewrite pow1, S_INR. field. exact Hg.
Qed.
