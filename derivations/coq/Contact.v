(** Contact of a blend with its base, of every order, and conditions (1.1), (2.1) and (3.1) as they have to be.

    The blend P leaves the base Q backwards: P(u) and Q(w_s - a u) agree at u = 0 up to derivatives of order n. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives Independence.
Open Scope R_scope.

(** Every derivative of the blend up to order n is that of the base, by factors c_0, c_1, .. *)
Definition contact_by (c : nat -> R) n m t p P m' w q Q : Prop := forall k, (k <= n)%nat ->
  exists y, start_derivative k m' w q Q y /\ start_derivative k m t p P (c k * y).
Definition contact (n : nat) (a : R) := contact_by (fun k => (- a) ^ k) n.

(** Rows of contact, of every order up to the degree of the blend, for every degree of the base. *)
Theorem contact_rows_by c n m t p P m' w q Q : ascending t -> clamped t p -> ascending w -> clamped w q ->
  (n <= p <= m)%nat -> (q <= m')%nat ->
  contact_by c n m t p P m' w q Q <->
  (forall i, (i <= n)%nat -> P i = sum (S i) (fun k => weight t p i k * (c k * differences k q (knot w q) Q))).
Proof.
  intros up C up' C' Hn Hq.
  rewrite <- (rows_iff n t p P (fun k => c k * differences k q (knot w q) Q) up C) by lia.
  assert (E : forall k, dend k w q Q = differences k q (knot w q) Q) by (intro; now apply end_derivatives).
  split; intros H k Hk.
  - destruct (H k Hk) as (y & Hy & Hp). apply start_derivative_iff in Hy, Hp; auto; [|lia].
    now rewrite <- Hp, Hy, E.
  - exists (dend k w q Q). split; [now apply start_derivative_is|]. apply start_derivative_iff; auto; [lia|].
    now rewrite H, E by exact Hk.
Qed.

Corollary contact_rows n a m t p P m' w q Q : ascending t -> clamped t p -> ascending w -> clamped w q ->
  (n <= p <= m)%nat -> (q <= m')%nat ->
  contact n a m t p P m' w q Q <->
  (forall i, (i <= n)%nat -> P i = sum (S i) (fun k => weight t p i k * ((- a) ^ k * differences k q (knot w q) Q))).
Proof. apply contact_rows_by. Qed.

(** General p_1, p_2, .. of (15) and (16): the k-th derivative of Q(w_s + p_1 x + p_2 x^2 / 2 + ..) is the sum over j of
    B_kj(p_1, p_2, ..) times the j-th one of Q, by Bell's recursion on the last derivative that is taken. *)
Fixpoint bell (f : nat) (g : nat -> R) (k j : nat) : R :=
  match f with O => 0 | S f' =>
  match k, j with
  | O, O => 1
  | S k', S j' => sum (S k') (fun i => C k' i * g (S i) * bell f' g (k' - i) j')
  | _, _ => 0
  end end.
Definition bell_polynomial g k j := bell (S k) g k j.

Definition contact_general (n : nat) (g : nat -> R) m t p P m' w q Q : Prop := forall k, (k <= n)%nat ->
  exists y : nat -> R, (forall j, (j <= k)%nat -> start_derivative j m' w q Q (y j)) /\
    start_derivative k m t p P (sum (S k) (fun j => bell_polynomial g k j * y j)).

Theorem contact_general_rows n g m t p P m' w q Q : ascending t -> clamped t p -> ascending w -> clamped w q ->
  (n <= p <= m)%nat -> (q <= m')%nat ->
  contact_general n g m t p P m' w q Q <->
  (forall i, (i <= n)%nat -> P i = sum (S i) (fun k => weight t p i k *
    sum (S k) (fun j => bell_polynomial g k j * differences j q (knot w q) Q))).
Proof.
  intros up C up' C' Hn Hq.
  rewrite <- (rows_iff n t p P (fun k => sum (S k) (fun j => bell_polynomial g k j * differences j q (knot w q) Q)) up C)
    by lia.
  assert (E : forall k, dend k w q Q = differences k q (knot w q) Q) by (intro; now apply end_derivatives).
  split; intros H k Hk.
  - destruct (H k Hk) as (y & Hy & Hp). apply start_derivative_iff in Hp; auto; [|lia]. rewrite <- Hp.
    apply sum_ext. intros j Hj. rewrite <- E. f_equal. apply (start_derivative_iff j m' w q Q); auto. apply Hy. lia.
  - exists (fun j => dend j w q Q). split; [intros; now apply start_derivative_is|].
    apply start_derivative_iff; auto; [lia|]. rewrite H by exact Hk. apply sum_ext. intros. now rewrite E.
Qed.

(** Derivatives of orders 1 and 2 by p_1, p_2: the right sides of (15) and (16) across the contact. *)
Lemma bell_1 g : bell_polynomial g 1 0 = 0 /\ bell_polynomial g 1 1 = g 1%nat.
Proof. unfold bell_polynomial. simpl. unfold C. simpl. split; [reflexivity|field]. Qed.

Lemma bell_2 g : bell_polynomial g 2 0 = 0 /\ bell_polynomial g 2 1 = g 2%nat /\ bell_polynomial g 2 2 = g 1%nat ^ 2.
Proof. unfold bell_polynomial. simpl. unfold C. simpl. repeat split; field. Qed.

Lemma knot_positive s r j : ascending s -> clamped s r -> (1 <= j)%nat -> 0 < knot s r j.
Proof.
  intros Hs [_ H] Hj. unfold knot. pose proof (ascending_le s Hs (S r) (r + j) ltac:(lia)). lra.
Qed.

Section Conditions.
Variables (m : nat) (t : nat -> R) (p : nat) (m' : nat) (w : nat -> R) (q : nat).
Hypotheses (up : ascending t) (Ct : clamped t p) (up' : ascending w) (Cw : clamped w q).
Hypotheses (Hp : (1 <= p <= m)%nat) (Hq : (1 <= q <= m')%nat).
Let u := knot t p.
Let h := knot w q.

(** (1.1) *)
Theorem condition_1_1 a P Q : contact 0 a m t p P m' w q Q <-> P O = Q O.
Proof.
  rewrite (contact_rows 0) by (auto; lia). split; intro H.
  - rewrite (H O) by lia. cbn. unfold weight. cbn. rewrite Nat.sub_0_r. field. apply Rgt_not_eq, fact_positive.
  - intros i Hi. replace i with O by lia. rewrite H. cbn. unfold weight. cbn. rewrite Nat.sub_0_r. field.
    apply Rgt_not_eq, fact_positive.
Qed.

Lemma contact_step n a P Q : (S n <= p)%nat -> contact (S n) a m t p P m' w q Q <->
  contact n a m t p P m' w q Q /\ dend (S n) t p P = (- a) ^ S n * dend (S n) w q Q.
Proof.
  intro Hn. split.
  - intro H. split; [intros k Hk; apply H; lia|]. destruct (H (S n) (le_n _)) as (y & Hy & Hz).
    apply start_derivative_iff in Hy, Hz; auto; try lia. now rewrite <- Hz, Hy.
  - intros [H E] k Hk. destruct (Nat.eq_dec k (S n)) as [->|]; [|apply H; lia].
    exists (dend (S n) w q Q). split; [apply start_derivative_is; auto; lia|].
    rewrite <- E. apply start_derivative_is; auto; lia.
Qed.

(** (2.1) is right, for every degree, every knot vector and every a = alpha^2. *)
Theorem condition_2_1 a P Q : contact 1 a m t p P m' w q Q <-> P O = Q O /\
  P 1%nat = a * u 1%nat * INR q / (h 1%nat * INR p) * (Q O - Q 1%nat) + P O.
Proof.
  rewrite contact_step, condition_1_1, !end_derivatives, !first_derivative by (auto; lia).
  fold u h. pose proof (knot_positive t p 1 up Ct ltac:(lia)) as U. pose proof (knot_positive w q 1 up' Cw ltac:(lia)) as H.
  fold u in U. fold h in H. assert (Np : INR p <> 0) by (apply not_0_INR; lia).
  split; intros [E0 E1]; split; auto.
  - transitivity (u 1%nat / INR p * (INR p / u 1%nat * (P 1%nat - P O)) + P O); [|rewrite E1]; field; lra.
  - rewrite E1. field. lra.
Qed.

(** (3.1) as it has to be: differences of first derivatives, each over its own span. *)
Theorem condition_3_1 a P Q : (2 <= p)%nat -> contact 2 a m t p P m' w q Q <-> contact 1 a m t p P m' w q Q /\
  P 2%nat = P 1%nat + u 2%nat / u 1%nat * (P 1%nat - P O)
    + a ^ 2 * (u 1%nat * u 2%nat * INR q * (INR q - 1)) / (h 1%nat * INR p * (INR p - 1))
      * ((Q 2%nat - Q 1%nat) / h 2%nat - (Q 1%nat - Q O) / h 1%nat).
Proof.
  intro Hp'. rewrite contact_step, !end_derivatives, !second_derivative by (auto; lia). fold u h.
  pose proof (knot_positive t p 1 up Ct ltac:(lia)) as U. pose proof (knot_positive t p 2 up Ct ltac:(lia)) as U'.
  pose proof (knot_positive w q 1 up' Cw ltac:(lia)) as H. pose proof (knot_positive w q 2 up' Cw ltac:(lia)) as H'.
  fold u in U, U'. fold h in H, H'.
  assert (Np : 2 <= INR p) by (apply (le_INR 2); lia).
  split; intros [E1 E2]; (split; [exact E1|]).
  - transitivity (P 1%nat + u 2%nat / u 1%nat * (P 1%nat - P O) + u 1%nat * u 2%nat / (INR p * (INR p - 1))
      * (INR p * (INR p - 1) / u 1%nat * ((P 2%nat - P 1%nat) / u 2%nat - (P 1%nat - P O) / u 1%nat)));
      [|rewrite E2]; field; lra.
  - rewrite E2. field. lra.
Qed.
End Conditions.
