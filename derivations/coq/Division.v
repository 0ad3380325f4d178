(** A Bezier patch divided by a Bezier function: (4) to (6), and the formula below (6), for every m, n and k. *)
From Coq Require Import Reals Lra Lia List.
From Semispline Require Import Sums.
Import ListNotations.
Open Scope R_scope.

Definition bern (n i : nat) (x : R) : R := C n i * x ^ i * (1 - x) ^ (n - i).
Definition bezier (n : nat) (P : nat -> R) (x : R) : R := sum (S n) (fun i => P i * bern n i x).
(** One step of de Casteljau. *)
Definition casteljau (x : R) (P : nat -> R) (i : nat) : R := (1 - x) * P i + x * P (S i).

Lemma C_first n : C n 0 = 1.
Proof. unfold C. rewrite Nat.sub_0_r. cbn. field. apply not_0_INR, fact_neq_0. Qed.
Lemma C_last n : C n n = 1.
Proof. unfold C. rewrite Nat.sub_diag. cbn. field. apply not_0_INR, fact_neq_0. Qed.
Lemma C_not_zero n i : C n i <> 0.
Proof.
  unfold C. apply Rmult_integral_contrapositive_currified; [|apply Rinv_neq_0_compat, Rmult_integral_contrapositive_currified];
    apply not_0_INR, fact_neq_0.
Qed.

(** C(n, i) = n! / (i! (n - i)!), and it is the binomial coefficient: Pascal's rule. *)
Lemma bern_step n i x : (i < n)%nat -> bern (S n) (S i) x = (1 - x) * bern n (S i) x + x * bern n i x.
Proof.
  intro H. unfold bern. rewrite <- (pascal n i H). cbn [pow Nat.sub].
  replace (n - i)%nat with (S (n - S i)) by lia. cbn [pow]. ring.
Qed.

Theorem de_casteljau n P x : bezier (S n) P x = bezier n (casteljau x P) x.
Proof.
  transitivity (sum (S n) (fun i => P i * ((1 - x) * bern n i x)) + sum (S n) (fun i => P (S i) * (x * bern n i x))).
  - unfold bezier. rewrite sum_first, (sum_first n (fun i => P i * _)). cbn [sum].
    rewrite (sum_ext n _ (fun i => P (S i) * ((1 - x) * bern n (S i) x) + P (S i) * (x * bern n i x)))
      by (intros i Hi; rewrite bern_step by exact Hi; ring).
    rewrite sum_add. unfold bern. rewrite !C_first, !C_last, !Nat.sub_0_r, !Nat.sub_diag. cbn [pow]. ring.
  - rewrite <- sum_add. apply sum_ext. intros. unfold casteljau. ring.
Qed.

Lemma bezier_ext n P Q x : (forall i, (i <= n)%nat -> P i = Q i) -> bezier n P x = bezier n Q x.
Proof. intro H. apply sum_ext. intros. rewrite H by lia. reflexivity. Qed.

(** Linear precision, and partition of unity: [eq-5], t = sum of (i / k) B_i^k(t). *)
Theorem linear_precision n a b x : bezier n (fun i => a + b * INR i) x = a + b * INR n * x.
Proof.
  revert a. induction n as [|n IH]; intro a; [unfold bezier, bern; cbn; rewrite C_first; ring|].
  rewrite de_casteljau, (bezier_ext _ _ (fun i => a + b * x + b * INR i)).
  - rewrite IH, S_INR. ring.
  - intros i _. unfold casteljau. rewrite S_INR. ring.
Qed.

Corollary bernstein_sum n x : bezier n (fun _ => 1) x = 1.
Proof.
  rewrite (bezier_ext _ _ (fun i => 1 + 0 * INR i)) by (intros; ring). rewrite linear_precision. ring.
Qed.

Corollary equation_5_abscissa k t : (0 < k)%nat -> bezier k (fun i => INR i / INR k) t = t.
Proof.
  intro H. rewrite (bezier_ext _ _ (fun i => 0 + / INR k * INR i)) by (intros; unfold Rdiv; ring).
  rewrite linear_precision. field. apply not_0_INR. lia.
Qed.

(** P_ij^s[x_1, .., x_s], the blossom; each argument is one step, and steps commute. *)
Fixpoint blossom (xs : list R) (P : nat -> R) (j : nat) : R :=
  match xs with [] => P j | x :: r => (1 - x) * blossom r P j + x * blossom r P (S j) end.

Lemma blossom_ext xs P Q : (forall j, P j = Q j) -> forall j, blossom xs P j = blossom xs Q j.
Proof. intro H. induction xs as [|x r IH]; intro j; cbn; [apply H|now rewrite !IH]. Qed.

Lemma blossom_linear xs a b P Q j :
  blossom xs (fun i => a * P i + b * Q i) j = a * blossom xs P j + b * blossom xs Q j.
Proof. revert j. induction xs as [|x r IH]; intro j; cbn; [reflexivity|rewrite !IH; ring]. Qed.

Lemma blossom_step xs x P j : blossom xs (casteljau x P) j = blossom (x :: xs) P j.
Proof. revert j. induction xs as [|y r IH]; intro j; cbn in *; [reflexivity|rewrite !IH; ring]. Qed.

(** The lower part of a curve, from 0 to c, and the upper one, from c to 1. *)
Theorem lower_part n c P y : bezier n P (c * y) = bezier n (fun s => blossom (repeat c s) P 0) y.
Proof.
  revert P. induction n as [|n IH]; intro P; [unfold bezier, bern; cbn; rewrite C_first; ring|].
  rewrite !de_casteljau, IH. apply bezier_ext. intros s _.
  transitivity (blossom (repeat c s) (fun i => (1 - y) * P i + y * casteljau c P i) 0).
  - apply blossom_ext. intro. unfold casteljau. ring.
  - rewrite blossom_linear, blossom_step. reflexivity.
Qed.

Lemma blossom_shift xs P j : blossom xs (fun i => P (S i)) j = blossom xs P (S j).
Proof. revert j. induction xs as [|x r IH]; intro j; cbn; [reflexivity|now rewrite !IH]. Qed.

Theorem upper_part n c P y : bezier n P (c + (1 - c) * y) = bezier n (fun s => blossom (repeat c (n - s)) P s) y.
Proof.
  revert P. induction n as [|n IH]; intro P; [unfold bezier, bern; cbn; rewrite C_first; ring|].
  rewrite !de_casteljau, IH. apply bezier_ext. intros s Hs.
  transitivity (blossom (repeat c (n - s)) (fun i => (1 - y) * casteljau c P i + y * P (S i)) s).
  - apply blossom_ext. intro. unfold casteljau. ring.
  - rewrite blossom_linear, blossom_step, blossom_shift. unfold casteljau.
    replace (S n - s)%nat with (S (n - s)) by lia. reflexivity.
Qed.

(** A blossom takes one argument at a time: the mean of values at the control points of the Bezier function. *)
Lemma blossom_weights r (b v : nat -> R) k P j : sum (S k) b = 1 ->
  blossom (sum (S k) (fun i => v i * b i) :: r) P j = sum (S k) (fun i => b i * blossom (v i :: r) P j).
Proof.
  intro H. cbn [blossom]. set (A := blossom r P j). set (B := blossom r P (S j)).
  transitivity (sum (S k) b * A + sum (S k) (fun i => v i * b i) * (B - A)); [rewrite H; ring|].
  rewrite Rmult_comm, <- sum_scale, (Rmult_comm _ (B - A)), <- sum_scale, <- sum_add. apply sum_ext. intros. ring.
Qed.

(** s sums, over j_1 .. j_s from 0 to k. *)
Fixpoint nested (k s : nat) (F : list nat -> R) : R :=
  match s with O => F [] | S r => sum (S k) (fun j => nested k r (fun js => F (j :: js))) end.

Fixpoint total (js : list nat) : nat := match js with [] => O | j :: r => (j + total r)%nat end.
Fixpoint product (f : nat -> R) (js : list nat) : R := match js with [] => 1 | j :: r => f j * product f r end.

Lemma nested_ext k s : forall F G, (forall js, length js = s -> Forall (fun j => (j <= k)%nat) js -> F js = G js) ->
  nested k s F = nested k s G.
Proof.
  induction s as [|s IH]; intros F G H; cbn [nested]; [apply H; auto|].
  apply sum_ext. intros j Hj. apply IH. intros js L A. apply H; [cbn; lia|constructor; [lia|exact A]].
Qed.

Lemma nested_scale k s c : forall F, nested k s (fun js => c * F js) = c * nested k s F.
Proof.
  induction s as [|s IH]; intro F; cbn [nested]; [reflexivity|]. rewrite <- sum_scale. apply sum_ext.
  intros j _. apply IH.
Qed.

Lemma blossom_nested k (b v : nat -> R) s : forall P j, sum (S k) b = 1 ->
  blossom (repeat (sum (S k) (fun i => v i * b i)) s) P j =
  nested k s (fun js => product b js * blossom (map v js) P j).
Proof.
  intros P j H. revert P j. induction s as [|s IH]; intros P j; [cbn; ring|].
  cbn [repeat nested]. rewrite blossom_weights by exact H. apply sum_ext. intros i _.
  rewrite <- blossom_step, IH, <- nested_scale. apply nested_ext. intros js _ _.
  cbn [map product]. rewrite blossom_step. ring.
Qed.

(** Products of Bernstein polynomials are Bernstein polynomials, up to a factor. *)
Lemma bern_product k m i u js : (i <= m)%nat -> Forall (fun j => (j <= k)%nat) js ->
  bern m i u * product (fun j => bern k j u) js =
  C m i * product (C k) js / C (m + length js * k) (i + total js) * bern (m + length js * k) (i + total js) u.
Proof.
  intros Hi H.
  assert (T : (total js <= length js * k)%nat) by (induction H; cbn in *; lia).
  assert (E : product (fun j => bern k j u) js = product (C k) js * u ^ total js * (1 - u) ^ (length js * k - total js)).
  { clear T. induction H as [|j r Hj Hr IH]; cbn [product length total]; [cbn; ring|].
    assert (T : (total r <= length r * k)%nat) by (clear IH; induction Hr; cbn in *; lia).
    rewrite IH. unfold bern. replace (S (length r) * k - (j + total r))%nat with ((k - j) + (length r * k - total r))%nat
      by (cbn; lia). rewrite !pow_add. ring. }
  rewrite E. unfold bern. replace (m + length js * k - (i + total js))%nat with ((m - i) + (length js * k - total js))%nat
    by lia. rewrite !pow_add. field. apply C_not_zero.
Qed.

(** (4), (5), and the control curve Q_j^s of a part, by the formula below (6). *)
Definition patch (m n : nat) (P : nat -> nat -> R) (u v : R) : R :=
  sum (S m) (fun i => sum (S n) (fun j => P i j * (bern m i u * bern n j v))).
Definition Q (m k : nat) (v : nat -> R) (P : nat -> nat -> R) (j s : nat) (u : R) : R :=
  sum (S m) (fun i => nested k s (fun js =>
    C m i * product (C k) js / C (m + s * k) (i + total js) * blossom (map v js) (P i) j
    * bern (m + s * k) (i + total js) u)).

Theorem formula_of_Q m k v P j s u :
  Q m k v P j s u = sum (S m) (fun i => bern m i u * blossom (repeat (bezier k v u) s) (P i) j).
Proof.
  apply sum_ext. intros i Hi. unfold bezier. rewrite blossom_nested by
    (rewrite <- (bernstein_sum k u); apply sum_ext; intros; ring).
  rewrite <- nested_scale. apply nested_ext. intros js L A.
  pose proof (bern_product k m i u js ltac:(lia) A) as E. rewrite L in E. rewrite <- Rmult_assoc, E. ring.
Qed.

Lemma patch_rows m n P u v : patch m n P u v = sum (S m) (fun i => bern m i u * bezier n (P i) v).
Proof.
  apply sum_ext. intros i _. unfold bezier. rewrite <- sum_scale. apply sum_ext. intros. ring.
Qed.

(** (6): the lower and the upper part. *)
Theorem equation_6_bottom m n k v P u y :
  patch m n P u (bezier k v u * y) = sum (S n) (fun s => Q m k v P 0 s u * bern n s y).
Proof.
  rewrite patch_rows. rewrite (sum_ext (S n) _ (fun s => sum (S m) (fun i =>
    bern m i u * blossom (repeat (bezier k v u) s) (P i) 0 * bern n s y))).
  - rewrite sum_swap. apply sum_ext. intros i _. rewrite lower_part. unfold bezier at 1. rewrite <- sum_scale.
    apply sum_ext. intros. ring.
  - intros s _. rewrite formula_of_Q, Rmult_comm, <- sum_scale. apply sum_ext. intros. ring.
Qed.

Theorem equation_6_top m n k v P u y :
  patch m n P u (bezier k v u + (1 - bezier k v u) * y) = sum (S n) (fun s => Q m k v P s (n - s) u * bern n s y).
Proof.
  rewrite patch_rows. rewrite (sum_ext (S n) _ (fun s => sum (S m) (fun i =>
    bern m i u * blossom (repeat (bezier k v u) (n - s)) (P i) s * bern n s y))).
  - rewrite sum_swap. apply sum_ext. intros i _. rewrite upper_part. unfold bezier at 1. rewrite <- sum_scale.
    apply sum_ext. intros. ring.
  - intros s _. rewrite formula_of_Q, Rmult_comm, <- sum_scale. apply sum_ext. intros. ring.
Qed.

(** Q_j^s is a Bezier curve of degree m + s k, with m + s k + 1 control points. *)
Definition is_bezier (d : nat) (f : R -> R) : Prop := exists c, forall x, f x = bezier d c x.

Lemma is_bezier_sum d n (f : nat -> R -> R) : (forall i, (i < n)%nat -> is_bezier d (f i)) ->
  is_bezier d (fun x => sum n (fun i => f i x)).
Proof.
  induction n as [|n IH]; intro H.
  - exists (fun _ => 0). intro x. unfold bezier. symmetry. apply sum_zero. intros. ring.
  - destruct IH as [a Ha]; [intros; apply H; lia|]. destruct (H n ltac:(lia)) as [b Hb].
    exists (fun i => a i + b i). intro x. cbn [sum]. rewrite Ha, Hb. unfold bezier. rewrite <- sum_add.
    apply sum_ext. intros. ring.
Qed.

Lemma is_bezier_nested d k s : forall F : list nat -> R -> R,
  (forall js, length js = s -> Forall (fun j => (j <= k)%nat) js -> is_bezier d (F js)) ->
  is_bezier d (fun x => nested k s (fun js => F js x)).
Proof.
  induction s as [|s IH]; intros F H; cbn [nested]; [now apply H|].
  apply is_bezier_sum. intros j Hj. apply (IH (fun js => F (j :: js))). intros js L A. apply H; [cbn; lia|].
  constructor; [lia|exact A].
Qed.

Theorem degree_of_Q m k v P j s : is_bezier (m + s * k) (Q m k v P j s).
Proof.
  apply is_bezier_sum. intros i Hi.
  apply (is_bezier_nested _ k s (fun js u => C m i * product (C k) js / C (m + s * k) (i + total js)
    * blossom (map v js) (P i) j * bern (m + s * k) (i + total js) u)).
  intros js L A. assert (T : (total js <= length js * k)%nat) by (clear L; induction A; cbn in *; lia). rewrite L in T.
  exists (fun e => if Nat.eq_dec e (i + total js)
    then C m i * product (C k) js / C (m + s * k) (i + total js) * blossom (map v js) (P i) j else 0).
  intro u. unfold bezier. rewrite (sum_single _ (i + total js)); [|lia|].
  - destruct Nat.eq_dec; [reflexivity|contradiction].
  - intros e _ He. destruct Nat.eq_dec; [contradiction|ring].
Qed.
