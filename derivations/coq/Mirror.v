(** The other end: over the knots -t_M, .., -t_0 a curve runs back, and spans are open at their start; at t_(m+1) it is
    the curve from the left, with the last span closed. *)
From Coq Require Import Reals Lra Lia.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives Independence Contact.
Open Scope R_scope.

Definition inside_left (a b x : R) : R := if Rlt_dec a x then if Rle_dec x b then 1 else 0 else 0.
Definition N_left (t : nat -> R) (p i : nat) (x : R) : R := cox (fun j => inside_left (t j) (t (S j)) x) t p i x.
Definition spline_left m t p P x := sum (S m) (fun i => P i * N_left t p i x).

Definition mirror (M : nat) (t : nat -> R) (j : nat) : R := - t (M - j)%nat.
Definition back (m : nat) (P : nat -> R) (i : nat) : R := P (m - i)%nat.

Lemma cox_mirror M d t p : forall i x, (S (i + p) <= M)%nat ->
  cox (fun j => d (M - S j)%nat) (mirror M t) p (M - S (i + p)) (- x) = cox d t p i x.
Proof.
  induction p as [|q IH]; intros i x H.
  - cbn. f_equal. lia.
  - rewrite !cox_step. unfold mirror.
    replace (M - (M - S (i + S q)))%nat with (S i + S q)%nat by lia.
    replace (M - (M - S (i + S q) + S q))%nat with (S i) by lia.
    replace (M - S (M - S (i + S q)))%nat with (i + S q)%nat by lia.
    replace (M - (S (M - S (i + S q)) + S q))%nat with i by lia.
    replace (M - S (i + S q))%nat with (M - S (S i + q))%nat at 1 by lia.
    replace (S (M - S (i + S q))) with (M - S (i + q))%nat by lia.
    fold (mirror M t). rewrite (IH i), (IH (S i)) by lia.
    replace (- t (S i) - - t (S i + S q)%nat) with (t (S i + S q)%nat - t (S i)) by ring.
    replace (- t i - - t (i + S q)%nat) with (t (i + S q)%nat - t i) by ring. ring.
Qed.

(** The same curve, at every x. *)
Theorem mirrored m t p P x : spline m (mirror (m + S p) t) p (back m P) (- x) = spline_left m t p P x.
Proof.
  unfold spline, spline_left. rewrite sum_reverse. apply sum_ext. intros i Hi.
  replace (S m - S i)%nat with (m - i)%nat by lia. unfold back. replace (m - (m - i))%nat with i by lia. f_equal.
  unfold N, N_left. rewrite <- (cox_mirror (m + S p) _ t p i x) by lia.
  replace (m + S p - S (i + p))%nat with (m - i)%nat by lia. apply cox_ext. intros j Hj.
  unfold mirror. replace (m + S p - S (m + S p - S j))%nat with j by lia.
  replace (S (m + S p - S j)) with (m + S p - j)%nat by lia.
  unfold inside, inside_left.
  destruct (Rle_dec (- t (m + S p - j)%nat) (- x)), (Rlt_dec (- x) (- t (m + S p - S j)%nat)),
    (Rlt_dec (t (m + S p - S j)%nat) x), (Rle_dec x (t (m + S p - j)%nat)); lra.
Qed.

Lemma mirror_ascending M t : ascending t -> ascending (mirror M t).
Proof. intros up j. unfold mirror. pose proof (ascending_le t up (M - S j) (M - j) ltac:(lia)). lra. Qed.

Lemma mirror_clamped m t p : clamped_end t p m -> clamped (mirror (m + S p) t) p.
Proof.
  intros [E H]. unfold mirror. split.
  - intros i Hi. replace (m + S p - i)%nat with (S m + (p - i))%nat by lia.
    replace (m + S p - p)%nat with (S m + 0)%nat by lia. rewrite !E by lia. reflexivity.
  - replace (m + S p - p)%nat with (S m) by lia. replace (m + S p - S p)%nat with m by lia. lra.
Qed.

(** The k-th derivative at the end, from the left. *)
Definition last_span (t : nat -> R) (m : nat) (x : R) : Prop := t m < x <= t (S m).
Definition end_derivative k m t p P y : Prop :=
  exists g, derivatives_on (last_span t m) k (spline_left m t p P) g /\ g (t (S m)) = y.

Lemma derivative_mirror (D : R -> Prop) f g : derivative_on D f g ->
  derivative_on (fun x => D (- x)) (fun x => f (- x)) (fun x => - g (- x)).
Proof.
  intros H x Hx eps He. destruct (H (- x) Hx eps He) as (a & Ha & Hd). exists a. split; [exact Ha|].
  intros y [[Dy Hne] Hy]. cbn in *. unfold R_dist in *.
  specialize (Hd (- y)). replace (- y - - x) with (- (y - x)) in Hd by ring. rewrite Rabs_Ropp in Hd.
  specialize (Hd ltac:(split; [split; [exact Dy|intro; apply Hne; lra]|exact Hy])).
  replace ((f (- y) - f (- x)) / (y - x) - - g (- x)) with (- ((f (- y) - f (- x)) / - (y - x) - g (- x)));
    [now rewrite Rabs_Ropp|]. field. intro; apply Hne; lra.
Qed.

Lemma derivatives_mirror (D : R -> Prop) k : forall f g, derivatives_on D k f g ->
  derivatives_on (fun x => D (- x)) k (fun x => f (- x)) (fun x => (-1) ^ k * g (- x)).
Proof.
  induction k as [|k IH]; intros f g H.
  - intros x Hx. rewrite (H (- x) Hx). cbn. ring.
  - destruct H as (h & Hf & Hh). exists (fun x => - h (- x)). split; [now apply derivative_mirror|].
    assert (E : derivatives_on D k (fun x => - h x) (fun x => - g x)).
    { clear - Hh. revert h g Hh. induction k as [|k IH]; intros h g Hh.
      - intros x Hx. now rewrite (Hh x Hx).
      - destruct Hh as (h' & H & H'). exists (fun x => - h' x). split; [|now apply IH].
        intros x Hx eps He. destruct (H x Hx eps He) as (a & Ha & Hd). exists a. split; [exact Ha|].
        intros y Hy. specialize (Hd y Hy). cbn in *. unfold R_dist in *.
        replace ((- h y - - h x) / (y - x) - - h' x) with (- ((h y - h x) / (y - x) - h' x));
          [now rewrite Rabs_Ropp|]. field. destruct Hy as [[_ Hne] _]. intro; apply Hne; lra. }
    apply IH in E. revert E. apply derivatives_ext; [reflexivity|]. intros x _. cbn. ring.
Qed.

Theorem end_derivative_iff k m t p P y : ascending t -> clamped_end t p m -> (p <= m)%nat ->
  end_derivative k m t p P y <-> y = (-1) ^ k * differences k p (knot (mirror (m + S p) t) p) (back m P).
Proof.
  intros up C Hm. set (s := mirror (m + S p) t).
  assert (up' : ascending s) by now apply mirror_ascending. assert (C' : clamped s p) by now apply mirror_clamped.
  rewrite <- end_derivatives by assumption.
  assert (S1 : (-1) ^ k * (-1) ^ k = 1).
  { rewrite <- Rpow_mult_distr. replace (-1 * -1) with 1 by ring. apply pow1. }
  assert (Ep : - s p = t (S m)) by (unfold s, mirror; replace (m + S p - p)%nat with (S m) by lia; ring).
  assert (Eq : - s (S p) = t m) by (unfold s, mirror; replace (m + S p - S p)%nat with m by lia; ring).
  assert (K : start_derivative k m s p (back m P) ((-1) ^ k * y) <-> (-1) ^ k * y = dend k s p (back m P))
    by now apply start_derivative_iff.
  transitivity ((-1) ^ k * y = dend k s p (back m P)).
  - rewrite <- K. split; intros (g & Hg & H); apply derivatives_mirror in Hg.
    + exists (fun x => (-1) ^ k * g (- x)). split; [|now rewrite Ep, H].
      apply (derivatives_subset _ (span s p)) in Hg; [|intros x [H1 H2]; split; lra].
      revert Hg. apply derivatives_ext; [|reflexivity]. intros x _.
      rewrite <- mirrored, Ropp_involutive. reflexivity.
    + exists (fun x => (-1) ^ k * g (- x)). split; [|rewrite <- Ep, Ropp_involutive, H; rewrite <- Rmult_assoc, S1; ring].
      apply (derivatives_subset _ (last_span t m)) in Hg; [|intros x [H1 H2]; split; lra].
      revert Hg. apply derivatives_ext; [|reflexivity]. intros x _. exact (mirrored m t p P x).
  - split; intro E; [rewrite <- E|rewrite E]; rewrite <- Rmult_assoc, S1; ring.
Qed.

(** Contact at u = 1: P(u_end + x) and Q(t_s + b x) agree at x = 0, the blend from the left, the base from the right. *)
Definition end_contact n b m t p P m' w q Q : Prop := forall k, (k <= n)%nat ->
  exists y, start_derivative k m' w q Q y /\ end_derivative k m t p P (b ^ k * y).

Lemma minus_power b k : (- b) ^ k = (-1) ^ k * b ^ k.
Proof. replace (- b) with (-1 * b) by ring. apply Rpow_mult_distr. Qed.

Lemma minus_one_twice k : (-1) ^ k * (-1) ^ k = 1.
Proof. rewrite <- Rpow_mult_distr. replace (-1 * -1) with 1 by ring. apply pow1. Qed.

Theorem end_contact_iff n b m t p P m' w q Q : ascending t -> clamped_end t p m -> (p <= m)%nat ->
  end_contact n b m t p P m' w q Q <-> contact n b m (mirror (m + S p) t) p (back m P) m' w q Q.
Proof.
  intros up E Hm. pose proof (mirror_ascending (m + S p) t up) as up'. pose proof (mirror_clamped m t p E) as C'.
  split; intros H k Hk; destruct (H k Hk) as (y & Hy & Hz); exists y; (split; [exact Hy|]).
  - apply end_derivative_iff in Hz; auto. apply start_derivative_iff; auto.
    rewrite end_derivatives, minus_power, Rmult_assoc, Hz, <- Rmult_assoc, minus_one_twice by assumption. ring.
  - apply start_derivative_iff in Hz; auto. apply end_derivative_iff; auto.
    rewrite end_derivatives, minus_power in Hz by assumption.
    rewrite <- Hz, <- !Rmult_assoc, minus_one_twice. ring.
Qed.

(** Distances of the last inner knots from the end: 1 - u_(m-k+1), 1 - u_(m-k), .. where the end is 1. *)
Definition last_knot (t : nat -> R) (m j : nat) : R := t (S m) - t (S m - j)%nat.

Lemma knot_mirror m t p j : knot (mirror (m + S p) t) p j = last_knot t m j.
Proof.
  unfold knot, mirror, last_knot. replace (m + S p - (p + j))%nat with (S m - j)%nat by lia.
  replace (m + S p - p)%nat with (S m) by lia. ring.
Qed.

Section Conditions.
Variables (m : nat) (t : nat -> R) (p : nat) (m' : nat) (w : nat -> R) (q : nat).
Hypotheses (up : ascending t) (Ct : clamped_end t p m) (up' : ascending w) (Cw : clamped w q).
Hypotheses (Hp : (1 <= p <= m)%nat) (Hq : (1 <= q <= m')%nat).
Let u := last_knot t m.
Let h := knot w q.

(** (2.2) is right if its knot is the last inner one, which is u_(m-3) for k = 4. *)
Theorem condition_2_2 b P Q : end_contact 1 b m t p P m' w q Q <-> P m = Q O /\
  P (m - 1)%nat = b * u 1%nat * INR q / (h 1%nat * INR p) * (Q O - Q 1%nat) + P m.
Proof.
  rewrite end_contact_iff, condition_2_1, knot_mirror by (auto using mirror_ascending, mirror_clamped; lia).
  unfold back. rewrite Nat.sub_0_r. reflexivity.
Qed.

(** (3.2) as it has to be. *)
Theorem condition_3_2 b P Q : (2 <= p)%nat -> end_contact 2 b m t p P m' w q Q <->
  end_contact 1 b m t p P m' w q Q /\
  P (m - 2)%nat = P (m - 1)%nat + u 2%nat / u 1%nat * (P (m - 1)%nat - P m)
    + b ^ 2 * (u 1%nat * u 2%nat * INR q * (INR q - 1)) / (h 1%nat * INR p * (INR p - 1))
      * ((Q 2%nat - Q 1%nat) / h 2%nat - (Q 1%nat - Q O) / h 1%nat).
Proof.
  intro H2. rewrite !end_contact_iff, condition_3_1, !knot_mirror
    by (auto using mirror_ascending, mirror_clamped; lia).
  unfold back. rewrite Nat.sub_0_r. reflexivity.
Qed.
End Conditions.
