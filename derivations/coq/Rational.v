(** What generated lemmas are stated with and closed by: rational numbers, their identities, counterexamples, signs. *)
From Coq Require Export QArith Qpower Qabs List.
From Coq Require Import Qfield Lqa Lia.
Export ListNotations.
Open Scope Q_scope.

Notation number := QArith_base.Q.
Global Arguments Qred : simpl never.
Global Arguments Qplus : simpl never.
Global Arguments Qmult : simpl never.
Global Arguments Qminus : simpl never.
Global Arguments Qopp : simpl never.

(** An identity of rational functions. What [field] leaves is that no denominator vanishes: each is a number, or one of
    the hypotheses up to a number, or the product of two of them. *)
Ltac absurd_by_product h := match goal with
  | H : ~ ?a == 0, H' : ~ ?b == 0 |- _ => apply H; apply (Qmult_integral_l b); [exact H'|]; clear H H'; lra
  | H : ~ ?a == 0 |- _ => apply H; apply (Qmult_integral_l a); [exact H|]; clear H; lra
  end.
Ltac nonzero := repeat split; try assumption;
  lazymatch goal with |- ~ ?e == 0 => let h := fresh in intro h; first
    [ lra | match goal with H : ~ ?a == 0 |- _ => apply H; clear H; lra end | absurd_by_product h ] end.
Ltac rational := cbv zeta; intros; repeat match goal with x := _ |- _ => subst x end; solve [field; nonzero].

(** Numbers. *)
Ltac by_numbers := vm_compute; first [reflexivity | discriminate | intro; discriminate].

(** Signs of sums of products of powers. *)
Lemma even_nonneg a n : 0 <= a ^ (2 * n).
Proof. rewrite Qpower_mult. apply Qpower_pos. change (0 <= a * a). nra. Qed.

Lemma product_positive a b : 0 < a -> 0 < b -> 0 < a * b.
Proof. nra. Qed.

Ltac nonneg := lazymatch goal with
  | |- 0 <= ?a + ?b => apply (Qplus_le_compat 0 a 0 b); nonneg
  | |- 0 <= ?a * ?b => apply Qmult_le_0_compat; nonneg
  | |- 0 <= ?a ^ ?n => first [apply Qpower_pos; nonneg
      | let k := eval compute in (Z.div n 2) in change (0 <= a ^ (2 * k)); apply even_nonneg]
  | |- _ => first [assumption | apply Qlt_le_weak; assumption | by_numbers]
  end.
Lemma sum_positive_left a b : 0 < a -> 0 <= b -> 0 < a + b.
Proof. lra. Qed.
Lemma sum_positive_right a b : 0 <= a -> 0 < b -> 0 < a + b.
Proof. lra. Qed.
Ltac positive := lazymatch goal with
  | |- 0 < ?a + ?b => first [apply sum_positive_right; [nonneg|positive] | apply sum_positive_left; [positive|nonneg]]
  | |- 0 < ?a * ?b => apply product_positive; positive
  | |- 0 < ?a ^ ?n => apply Qpower_0_lt; positive
  | |- _ => first [assumption | by_numbers]
  end.

(** One sum of positive terms over another. *)
Theorem quotient_positive x over under : x * under == over -> 0 < over -> 0 < under -> 0 < x.
Proof. intros E Ho Hu. rewrite <- E in Ho. destruct (Qlt_le_dec 0 x); [assumption|nra]. Qed.

Theorem quotient_nonneg x over under : x * under == over -> 0 <= over -> 0 < under -> 0 <= x.
Proof. intros E Ho Hu. rewrite <- E in Ho. destruct (Qlt_le_dec x 0); [nra|assumption]. Qed.

(** Facts of printed lists of numbers: order k, so that the inner knots are those between the k first and k last ones. *)
Fixpoint increasing (v : list number) : bool :=
  match v with a :: ((b :: _) as r) => Qle_bool a b && increasing r | _ => true end.
Definition equal_lists (v w : list number) : bool :=
  Nat.eqb (length v) (length w) && forallb (fun p => Qeq_bool (fst p) (snd p)) (combine v w).
Definition inner (k : nat) (v : list number) := firstn (length v - k - k) (skipn k v).
Definition clamped (k : nat) (v : list number) : bool :=
  equal_lists (firstn k v) (repeat 0 k) && equal_lists (skipn (length v - k) v) (repeat 1 k).
Fixpoint different (v : list number) : bool :=
  match v with a :: r => negb (existsb (Qeq_bool a) r) && different r | [] => true end.
Definition single (k : nat) (v : list number) : bool := different (inner k v)
  && forallb (fun x => Qle_bool 0 x && negb (Qeq_bool x 0) && Qle_bool x 1 && negb (Qeq_bool x 1)) (inner k v).
Definition points (k n : nat) (v : list number) : bool := Nat.eqb (length v) (n + k).
