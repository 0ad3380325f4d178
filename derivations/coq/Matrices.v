(** Matrices of rational numbers: rank, columns that are combinations of others, positive definite forms. A matrix is
    a list of rows; what is proved of it is said with its entries, and certificates are checked by computing. *)
From Coq Require Import ZArith Lia Lqa Setoid Morphisms.
From Semispline Require Import Rational.
Open Scope Q_scope.

Fixpoint sum (n : nat) (f : nat -> number) : number := match n with O => 0 | S k => sum k f + f k end.
Definition entry (M : list (list number)) (i j : nat) : number := nth j (nth i M []) 0.

Lemma sum_ext n f g : (forall i, (i < n)%nat -> f i == g i) -> sum n f == sum n g.
Proof. induction n as [|n IH]; intro H; cbn; [reflexivity|]. rewrite IH, H by (intros; try apply H; lia). reflexivity. Qed.
Lemma sum_zero n f : (forall i, (i < n)%nat -> f i == 0) -> sum n f == 0.
Proof. induction n as [|n IH]; intro H; cbn; [reflexivity|]. rewrite IH, H by (intros; try apply H; lia). reflexivity. Qed.
Lemma sum_add n f g : sum n (fun i => f i + g i) == sum n f + sum n g.
Proof. induction n as [|n IH]; cbn; [reflexivity|]. rewrite IH. ring. Qed.
Lemma sum_scale n c f : sum n (fun i => c * f i) == c * sum n f.
Proof. induction n as [|n IH]; cbn; [ring|]. rewrite IH. ring. Qed.
Lemma sum_swap m n f : sum m (fun i => sum n (fun j => f i j)) == sum n (fun j => sum m (fun i => f i j)).
Proof. induction m as [|m IH]; cbn; [symmetry; now apply sum_zero|]. rewrite IH, <- sum_add. reflexivity. Qed.
Lemma sum_nonneg n f : (forall i, (i < n)%nat -> 0 <= f i) -> 0 <= sum n f.
Proof.
  induction n as [|n IH]; intro H; cbn; [apply Qle_refl|].
  apply (Qplus_le_compat 0 _ 0); [apply IH; intros|]; apply H; lia.
Qed.
Lemma sum_positive n i f : (i < n)%nat -> (forall j, (j < n)%nat -> 0 <= f j) -> 0 < f i -> 0 < sum n f.
Proof.
  induction n as [|n IH]; intros Hi H F; [lia|]. cbn. destruct (Nat.eq_dec i n) as [->|N].
  - apply sum_positive_right; [|exact F]. apply sum_nonneg. intros. apply H. lia.
  - apply sum_positive_left; [|apply H; lia]. apply IH; [lia| |exact F]. intros. apply H. lia.
Qed.
Lemma sum_le n f g : (forall i, (i < n)%nat -> f i <= g i) -> sum n f <= sum n g.
Proof.
  induction n as [|n IH]; intro H; cbn; [apply Qle_refl|]. apply Qplus_le_compat; [apply IH; intros|]; apply H; lia.
Qed.
Lemma sum_single n j f : (j < n)%nat -> (forall i, (i < n)%nat -> i <> j -> f i == 0) -> sum n f == f j.
Proof.
  induction n as [|n IH]; intros Hj H; [lia|]. cbn. destruct (Nat.eq_dec j n) as [->|N].
  - rewrite sum_zero; [ring|]. intros i Hi. apply H; lia.
  - rewrite IH, (H n); [ring|lia|lia|lia|]. intros i Hi. apply H. lia.
Qed.

(** Checks over all indices. *)
Definition all (n : nat) (f : nat -> bool) : bool := forallb f (seq 0 n).
Lemma all_spec n f : all n f = true -> forall i, (i < n)%nat -> f i = true.
Proof. unfold all. rewrite forallb_forall. intros H i Hi. apply H, in_seq. lia. Qed.
Fixpoint reduced_sum (n : nat) (f : nat -> number) : number :=
  match n with O => 0 | S k => Qred (reduced_sum k f + f k) end.
Lemma reduced_sum_is n f : reduced_sum n f == sum n f.
Proof. induction n as [|n IH]; cbn; [reflexivity|]. now rewrite Qred_correct, IH. Qed.
Definition same (x y : number) : bool := Qeq_bool x y.
Definition unit (i j : nat) : number := if Nat.eqb i j then 1 else 0.

(** Column j of B is a combination of the columns of A; m rows, n columns of A. *)
Definition combination (m n : nat) A B (j : nat) : Prop :=
  exists y : nat -> number, forall i, (i < m)%nat -> sum n (fun k => entry A i k * y k) == entry B i j.
Definition contained m n n' A B : Prop := forall j, (j < n')%nat -> combination m n A B j.

Definition product_is m n n' A X B := all m (fun i => all n' (fun j =>
  same (reduced_sum n (fun k => entry A i k * entry X k j)) (entry B i j))).
Theorem contained_by m n n' A B X : product_is m n n' A X B = true -> contained m n n' A B.
Proof.
  intros H j Hj. exists (fun k => entry X k j). intros i Hi.
  pose proof (all_spec _ _ (all_spec _ _ H i Hi) j Hj) as E. apply Qeq_bool_eq in E. now rewrite reduced_sum_is in E.
Qed.

(** A row that sends all columns of A to zero, and one of B not. *)
Definition separates m n A B y j := all n (fun k => same (reduced_sum m (fun i => nth i y 0 * entry A i k)) 0)
  && negb (same (reduced_sum m (fun i => nth i y 0 * entry B i j)) 0).
Theorem not_contained_by m n n' A B y j : (j < n')%nat -> separates m n A B y j = true -> ~ contained m n n' A B.
Proof.
  intros Hj H C. destruct (C j Hj) as [x Hx]. apply andb_prop in H. destruct H as [H1 H2].
  assert (E : sum m (fun i => nth i y 0 * entry B i j) == 0).
  { rewrite (sum_ext m _ (fun i => sum n (fun k => nth i y 0 * entry A i k * x k))).
    - rewrite sum_swap. apply sum_zero. intros k Hk.
      rewrite (sum_ext m _ (fun i => x k * (nth i y 0 * entry A i k))) by (intros; ring). rewrite sum_scale.
      pose proof (all_spec _ _ H1 k Hk) as Z. apply Qeq_bool_eq in Z. rewrite reduced_sum_is in Z. rewrite Z. ring.
    - intros i Hi. rewrite <- (Hx i Hi), <- sum_scale. apply sum_ext. intros. ring. }
  apply negb_true_iff in H2. rewrite <- (reduced_sum_is m) in E. unfold same in H2.
  apply Qeq_eq_bool in E. congruence.
Qed.

(** The rank: r independent columns, of which all others are combinations. *)
Definition rank_is (m n : nat) M (r : nat) : Prop := exists c : nat -> nat,
  (forall k, (k < r)%nat -> (c k < n)%nat) /\
  (forall y : nat -> number, (forall i, (i < m)%nat -> sum r (fun k => entry M i (c k) * y k) == 0) ->
    forall k, (k < r)%nat -> y k == 0) /\
  (forall j, (j < n)%nat -> exists y : nat -> number, forall i, (i < m)%nat ->
    sum r (fun k => entry M i (c k) * y k) == entry M i j).

(** Shown by a left inverse L of those columns, and the coefficients X of all columns. *)
Definition rank_check m n M r (cs : list nat) L X :=
  all r (fun k => Nat.ltb (nth k cs O) n) &&
  all r (fun k => all r (fun l => same (reduced_sum m (fun i => entry L k i * entry M i (nth l cs O))) (unit k l))) &&
  all m (fun i => all n (fun j => same (reduced_sum r (fun k => entry M i (nth k cs O) * entry X k j)) (entry M i j))).
Theorem rank_by m n M r cs L X : rank_check m n M r cs L X = true -> rank_is m n M r.
Proof.
  intro H. apply andb_prop in H. destruct H as [H H3]. apply andb_prop in H. destruct H as [H1 H2].
  exists (fun k => nth k cs O). split; [|split].
  - intros k Hk. apply Nat.ltb_lt, (all_spec _ _ H1 k Hk).
  - intros y Hy k Hk.
    transitivity (sum r (fun l => unit k l * y l)).
    + symmetry. rewrite (sum_single r k) by (auto; intros i _ N; unfold unit; apply Nat.eqb_neq in N;
        rewrite Nat.eqb_sym, N; ring). unfold unit. rewrite Nat.eqb_refl. ring.
    + rewrite (sum_ext r _ (fun l => sum m (fun i => entry L k i * (entry M i (nth l cs O) * y l)))).
      * rewrite sum_swap. apply sum_zero. intros i Hi. rewrite sum_scale, (Hy i Hi). ring.
      * intros l Hl. pose proof (all_spec _ _ (all_spec _ _ H2 k Hk) l Hl) as E. apply Qeq_bool_eq in E.
        rewrite reduced_sum_is in E. rewrite <- E, Qmult_comm, <- sum_scale. apply sum_ext. intros. ring.
  - intros j Hj. exists (fun k => entry X k j). intros i Hi.
    pose proof (all_spec _ _ (all_spec _ _ H3 i Hi) j Hj) as E. apply Qeq_bool_eq in E. now rewrite reduced_sum_is in E.
Qed.

(** The quadratic form of a symmetric matrix, and that it is positive but at zero. *)
Definition form n A (x : nat -> number) : number := sum n (fun i => sum n (fun j => entry A i j * x i * x j)).
Definition positive_definite n A : Prop := (forall i j, (i < n)%nat -> (j < n)%nat -> entry A i j == entry A j i) /\
  forall x, (exists i, (i < n)%nat /\ ~ x i == 0) -> 0 < form n A x.

(** Shown by s A = F F^T + E, F of whole numbers, E with a diagonal that outweighs the rest of each row. *)
Fixpoint whole_dot (u v : list Z) : Z := match u, v with a :: u', b :: v' => (a * b + whole_dot u' v')%Z | _, _ => 0%Z end.
Definition rest (s : positive) A (F : list (list Z)) i j : number :=
  Qred (entry A i j * inject_Z (Zpos s) - inject_Z (whole_dot (nth i F []) (nth j F []))).
Definition definite_check n s A F :=
  all n (fun i => all n (fun j => same (entry A i j) (entry A j i))) &&
  all n (fun i => negb (Qle_bool (rest s A F i i)
    (reduced_sum n (fun j => if Nat.eqb i j then 0 else Qabs (rest s A F i j))))).

Lemma whole_dot_sum u v n : (length u <= n)%nat ->
  inject_Z (whole_dot u v) == sum n (fun k => inject_Z (nth k u 0%Z) * inject_Z (nth k v 0%Z)).
Proof.
  revert v n. induction u as [|a u IH]; intros v n H.
  - cbn. symmetry. apply sum_zero. intros [|k] _; cbn; ring.
  - destruct n as [|n]; [cbn in H; lia|].
    assert (First : forall f, sum (S n) f == f O + sum n (fun i => f (S i))).
    { clear. intro f. induction n as [|n IH]; [cbn; ring|].
      change (sum (S n) f + f (S n) == f O + (sum n (fun i => f (S i)) + f (S n))). rewrite IH. ring. }
    rewrite First. destruct v as [|b v]; cbn [whole_dot nth].
    + rewrite sum_zero by (intros [|k] _; cbn; ring). ring.
    + rewrite inject_Z_plus, inject_Z_mult, (IH v n) by (cbn in H; lia). reflexivity.
Qed.

Lemma square_nonneg x : 0 <= x * x.
Proof. nra. Qed.

Lemma mean_of_squares e x y : - (Qabs e * (x * x + y * y)) <= 2 * (e * x * y).
Proof.
  destruct (Qlt_le_dec e 0) as [H|H].
  - rewrite Qabs_neg by lra. assert (0 <= - e * ((x - y) * (x - y))) by (apply Qmult_le_0_compat; [lra|apply square_nonneg]). lra.
  - rewrite Qabs_pos by lra. assert (0 <= e * ((x + y) * (x + y))) by (apply Qmult_le_0_compat; [lra|apply square_nonneg]). lra.
Qed.

Theorem definite_by n s A F : definite_check n s A F = true -> positive_definite n A.
Proof.
  intro H. apply andb_prop in H. destruct H as [H1 H2].
  assert (Sym : forall i j, (i < n)%nat -> (j < n)%nat -> entry A i j == entry A j i).
  { intros i j Hi Hj. apply Qeq_bool_eq, (all_spec _ _ (all_spec _ _ H1 i Hi) j Hj). }
  split; [exact Sym|]. intros x (i0 & Hi0 & Nx).
  set (E i j := entry A i j * inject_Z (Zpos s) - inject_Z (whole_dot (nth i F []) (nth j F []))).
  assert (Dom : forall i, (i < n)%nat -> sum n (fun j => if Nat.eqb i j then 0 else Qabs (E i j)) < E i i).
  { intros i Hi. pose proof (all_spec _ _ H2 i Hi) as D. apply negb_true_iff in D.
    destruct (Qlt_le_dec (sum n (fun j => if Nat.eqb i j then 0 else Qabs (E i j))) (E i i)) as [L|L]; [exact L|].
    exfalso. assert (L' : Qle_bool (rest s A F i i)
      (reduced_sum n (fun j => if Nat.eqb i j then 0 else Qabs (rest s A F i j))) = true); [|congruence].
    apply Qle_bool_iff. unfold rest. rewrite reduced_sum_is, Qred_correct. fold (E i i).
    rewrite (sum_ext n _ (fun j => if Nat.eqb i j then 0 else Qabs (E i j))); [exact L|].
    intros j _. destruct (Nat.eqb i j); [reflexivity|]. now rewrite Qred_correct. }
  assert (SymE : forall i j, (i < n)%nat -> (j < n)%nat -> E i j == E j i).
  { intros i j Hi Hj. unfold E. rewrite (Sym i j Hi Hj).
    replace (whole_dot (nth j F []) (nth i F [])) with (whole_dot (nth i F []) (nth j F [])); [reflexivity|].
    generalize (nth i F []) (nth j F []). clear. induction l as [|a l IH]; intros [|b r]; cbn; [reflexivity..|].
    rewrite IH. ring. }
  assert (N : exists w, (forall i, (i < n)%nat -> (length (nth i F []) <= w)%nat)).
  { clear. induction n as [|n [w Hw]]; [exists O; intros; lia|]. exists (w + length (nth n F []))%nat.
    intros i Hi. destruct (Nat.eq_dec i n) as [->|]; [lia|]. specialize (Hw i). lia. }
  destruct N as [w Hw]. set (f i k := inject_Z (nth k (nth i F []) 0%Z)).
  assert (Split : inject_Z (Zpos s) * form n A x ==
    sum w (fun k => sum n (fun i => sum n (fun j => f i k * x i * (f j k * x j))))
    + sum n (fun i => sum n (fun j => E i j * x i * x j))).
  { unfold form. rewrite <- sum_scale.
    rewrite (sum_ext n _ (fun i => sum w (fun k => sum n (fun j => f i k * x i * (f j k * x j)))
      + sum n (fun j => E i j * x i * x j))).
    - rewrite sum_add, sum_swap. reflexivity.
    - intros i Hi. rewrite <- sum_scale, sum_swap, <- sum_add. apply sum_ext. intros j Hj.
      rewrite (sum_ext w _ (fun k => x i * x j * (f i k * f j k))) by (intros; ring). rewrite sum_scale.
      unfold f. rewrite <- whole_dot_sum by now apply Hw. unfold E. ring. }
  assert (Squares : 0 <= sum w (fun k => sum n (fun i => sum n (fun j => f i k * x i * (f j k * x j))))).
  { apply sum_nonneg. intros k _. rewrite (sum_ext n _ (fun i => sum n (fun j => f j k * x j) * (f i k * x i))).
    - rewrite sum_scale. apply square_nonneg.
    - intros i _. rewrite sum_scale. ring. }
  set (off i j := if Nat.eqb i j then 0 else Qabs (E i j)).
  assert (Off : sum n (fun i => sum n (fun j => off i j * (x j * x j))) ==
    sum n (fun i => sum n (fun j => off i j * (x i * x i)))).
  { rewrite sum_swap. apply sum_ext. intros i Hi. apply sum_ext. intros j Hj. unfold off.
    rewrite Nat.eqb_sym. destruct (Nat.eqb i j); [reflexivity|]. now rewrite (SymE j i). }
  assert (Rows : sum n (fun i => (E i i - sum n (off i)) * (x i * x i)) <= sum n (fun i => sum n (fun j => E i j * x i * x j))).
  { apply Qle_trans with (sum n (fun i => sum n (fun j => (if Nat.eqb i j then E i i * (x i * x i) else 0)
      + -(1#2) * (off i j * (x i * x i)) + -(1#2) * (off i j * (x j * x j))))).
    - rewrite (sum_ext n (fun i => sum n (fun j => _ + _)) (fun i => E i i * (x i * x i)
        + -(1#2) * sum n (fun j => off i j * (x i * x i)) + -(1#2) * sum n (fun j => off i j * (x j * x j)))).
      + rewrite !sum_add, !sum_scale, Off.
        rewrite (sum_ext n _ (fun i => E i i * (x i * x i) + (-1) * sum n (fun j => off i j * (x i * x i)))).
        * rewrite sum_add, sum_scale. lra.
        * intros i Hi. rewrite (sum_ext n (fun j => off i j * _) (fun j => x i * x i * off i j)) by (intros; ring).
          rewrite sum_scale. unfold Qminus. ring.
      + intros i Hi. rewrite !sum_add, !sum_scale.
        rewrite (sum_single n i (fun j => if Nat.eqb i j then _ else 0)); [|exact Hi|].
        * rewrite Nat.eqb_refl. reflexivity.
        * intros j _ Nj. apply not_eq_sym, Nat.eqb_neq in Nj. now rewrite Nj.
    - apply sum_le. intros i Hi. apply sum_le. intros j Hj. unfold off. destruct (Nat.eqb i j) eqn:Eij.
      + apply Nat.eqb_eq in Eij. subst j. lra.
      + pose proof (mean_of_squares (E i j) (x i) (x j)). lra. }
  assert (Strict : 0 < sum n (fun i => (E i i - sum n (off i)) * (x i * x i))).
  { assert (T : forall i, (i < n)%nat -> 0 <= (E i i - sum n (off i)) * (x i * x i)).
    { intros i Hi. apply Qmult_le_0_compat; [|apply square_nonneg]. specialize (Dom i Hi). unfold off. lra. }
    assert (T0 : 0 < (E i0 i0 - sum n (off i0)) * (x i0 * x i0)).
    { specialize (Dom i0 Hi0). fold (off i0) in Dom. apply product_positive; [lra|].
      destruct (Qlt_le_dec 0 (x i0)); nra. }
    apply (sum_positive n i0); assumption. }
  assert (P : 0 < inject_Z (Zpos s) * form n A x) by (rewrite Split; lra).
  assert (0 < inject_Z (Zpos s)) by reflexivity. destruct (Qlt_le_dec 0 (form n A x)); [assumption|nra].
Qed.

(** A quadratic energy with a positive definite form is least at the solution of its normal equation, and there alone. *)
Definition energy n A (b x : nat -> number) : number := form n A x + 2 * sum n (fun i => b i * x i).
Definition solves n A (b x : list number) := all n (fun i =>
  same (reduced_sum n (fun j => entry A i j * nth j x 0)) (- nth i b 0)).
Definition point (x : list number) (i : nat) : number := nth i x 0.

Theorem minimiser n s F A b x : definite_check n s A F = true -> solves n A b x = true ->
  forall d, (exists i, (i < n)%nat /\ ~ d i == 0) ->
    energy n A (point b) (point x) < energy n A (point b) (fun i => point x i + d i).
Proof.
  intros D S d Hd. destruct (definite_by n s A F D) as [Sym P]. specialize (P d Hd).
  assert (R : forall i, (i < n)%nat -> sum n (fun j => entry A i j * point x j) == - point b i).
  { intros i Hi. pose proof (all_spec _ _ S i Hi) as E. apply Qeq_bool_eq in E. now rewrite reduced_sum_is in E. }
  assert (E : energy n A (point b) (fun i => point x i + d i) == energy n A (point b) (point x) + form n A d).
  { unfold energy, form.
    rewrite (sum_ext n (fun i => sum n (fun j => entry A i j * (point x i + d i) * (point x j + d j))) (fun i =>
      sum n (fun j => entry A i j * point x i * point x j) + sum n (fun j => entry A i j * point x i * d j)
      + (d i * sum n (fun j => entry A i j * point x j) + sum n (fun j => entry A i j * d i * d j)))).
    2: { intros i _. rewrite <- sum_scale, <- !sum_add. apply sum_ext. intros. ring. }
    rewrite !sum_add, (sum_swap n n (fun i j => entry A i j * point x i * d j)).
    rewrite (sum_ext n (fun j => sum n (fun i => entry A i j * point x i * d j)) (fun i => - (point b i * d i))).
    2: { intros i Hi. rewrite (sum_ext n _ (fun j => d i * (entry A i j * point x j)))
           by (intros j Hj; rewrite (Sym j i Hj Hi); ring). rewrite sum_scale, (R i Hi). ring. }
    rewrite (sum_ext n (fun i => d i * sum n _) (fun i => - (point b i * d i))).
    2: { intros i Hi. rewrite (R i Hi). ring. }
    rewrite (sum_ext n (fun i => point b i * (point x i + d i)) (fun i => point b i * point x i + point b i * d i))
      by (intros; ring).
    rewrite sum_add, (sum_ext n (fun i => - (point b i * d i)) (fun i => -1 * (point b i * d i))) by (intros; ring).
    rewrite !sum_scale. ring. }
  rewrite E. lra.
Qed.
