(** Tangent planes, normal curvatures and principal curvatures at a point. *)
From Coq Require Import Reals Lra.
Open Scope R_scope.

Record vector := V { vx : R; vy : R; vz : R }.
Definition add a b := V (vx a + vx b) (vy a + vy b) (vz a + vz b).
Definition scale c a := V (c * vx a) (c * vy a) (c * vz a).
Definition dot a b := vx a * vx b + vy a * vy b + vz a * vz b.
Definition cross a b := V (vy a * vz b - vz a * vy b) (vz a * vx b - vx a * vz b) (vx a * vy b - vy a * vx b).
Definition zero := V 0 0 0.

Lemma vector_eq a b : vx a = vx b -> vy a = vy b -> vz a = vz b -> a = b.
Proof. destruct a, b. cbn. now intros -> -> ->. Qed.

Lemma dot_positive a : a <> zero -> 0 < dot a a.
Proof.
  intro H. unfold dot. destruct (Req_dec (vx a) 0) as [X|X], (Req_dec (vy a) 0) as [Y|Y], (Req_dec (vz a) 0) as [Z|Z];
    try nra. exfalso. apply H. now apply vector_eq.
Qed.

(** The plane of a and b. *)
Definition in_plane a b x : Prop := exists s t, x = add (scale s a) (scale t b).

(** x lies in the plane of a and b exactly if it is square to their normal. *)
Lemma in_plane_iff a b x : cross a b <> zero -> in_plane a b x <-> dot x (cross a b) = 0.
Proof.
  intro H. split.
  - intros (s & t & ->). unfold dot, add, scale, cross. cbn. ring.
  - intro E. pose proof (dot_positive _ H) as P. set (n := cross a b) in *.
    exists (dot (cross x b) n / dot n n), (dot (cross a x) n / dot n n).
    assert (K : forall f : vector -> R, (f = vx \/ f = vy \/ f = vz) ->
      dot n n * f x = dot (cross x b) n * f a + dot (cross a x) n * f b + dot x n * f n).
    { intros f [-> | [-> | ->]]; unfold n, dot, cross; cbn; ring. }
    apply vector_eq; cbn; apply (Rmult_eq_reg_l (dot n n)); try lra; rewrite K by tauto; rewrite E; field; lra.
Qed.

(** Tangent planes are one exactly if P_u x P_v is a multiple of R_w x R_v. *)
Theorem one_tangent_plane pu pv rw rv : cross pu pv <> zero -> cross rw rv <> zero ->
  (forall x, in_plane pu pv x <-> in_plane rw rv x) <-> exists c, cross pu pv = scale c (cross rw rv).
Proof.
  intros Hp Hr. split.
  - intro H. assert (A : in_plane rw rv pu) by (apply H; exists 1, 0; apply vector_eq; cbn; ring).
    assert (B : in_plane rw rv pv) by (apply H; exists 0, 1; apply vector_eq; cbn; ring).
    destruct A as (a & b & ->), B as (c & d & ->). exists (a * d - b * c). apply vector_eq; cbn; ring.
  - intros (c & E) x. rewrite !in_plane_iff by assumption. rewrite E.
    assert (c <> 0) by (intros ->; apply Hp; rewrite E; apply vector_eq; cbn; ring).
    replace (dot x (scale c (cross rw rv))) with (c * dot x (cross rw rv)) by (unfold dot, scale; cbn; ring).
    split; intro Z; [|rewrite Z; ring]. apply (Rmult_eq_reg_l c); lra.
Qed.

(** Normal curvature in direction (u, v), by first and second fundamental form. *)
Definition form a b c u v := a * u ^ 2 + 2 * b * u * v + c * v ^ 2.

(** With one first form, curvatures agree in all directions exactly if the second forms do. *)
Theorem curvatures_agree E F G L M N L' M' N' : (forall u v, u <> 0 \/ v <> 0 -> 0 < form E F G u v) ->
  (forall u v, u <> 0 \/ v <> 0 -> form L M N u v / form E F G u v = form L' M' N' u v / form E F G u v) <->
  L = L' /\ M = M' /\ N = N'.
Proof.
  intro P. split; [|intros (-> & -> & ->); reflexivity].
  intro H. assert (K : forall u v, u <> 0 \/ v <> 0 -> form L M N u v = form L' M' N' u v).
  { intros u v D. specialize (P u v D). specialize (H u v D). apply (f_equal (Rmult (form E F G u v))) in H.
    unfold Rdiv in H. rewrite (Rmult_comm (form L M N u v)), (Rmult_comm (form L' M' N' u v)), <- !Rmult_assoc in H.
    rewrite Rinv_r in H by lra. lra. }
  pose proof (K 1 0 ltac:(lra)) as K1. pose proof (K 0 1 ltac:(lra)) as K2. pose proof (K 1 1 ltac:(lra)) as K3.
  unfold form in *. repeat split; lra.
Qed.

(** Where lengths and angles are kept the first form is the identity, and principal curvatures are the eigenvalues of the
    second: they have its trace for sum and its determinant for product. *)
Definition eigen a b c k x y := a * x + b * y = k * x /\ b * x + c * y = k * y.
Theorem principal_curvatures a b c k l x y x' y' : eigen a b c k x y -> eigen a b c l x' y' -> x * y' - y * x' <> 0 ->
  k + l = a + c /\ k * l = a * c - b * b.
Proof.
  intros [E1 E2] [E3 E4] H. set (d := x * y' - y * x') in *.
  assert (A : a * d = k * x * y' - l * x' * y).
  { unfold d. replace (a * (x * y' - y * x')) with ((a * x + b * y) * y' - (a * x' + b * y') * y) by ring.
    rewrite E1, E3. ring. }
  assert (C : c * d = l * x * y' - k * x' * y).
  { unfold d. replace (c * (x * y' - y * x')) with ((b * x' + c * y') * x - (b * x + c * y) * x') by ring.
    rewrite E2, E4. ring. }
  assert (B : b * d = x * x' * (l - k)).
  { unfold d. replace (b * (x * y' - y * x')) with ((a * x' + b * y') * x - (a * x + b * y) * x') by ring.
    rewrite E1, E3. ring. }
  assert (B' : b * d = y * y' * (k - l)).
  { unfold d. replace (b * (x * y' - y * x')) with ((b * x + c * y) * y' - (b * x' + c * y') * y) by ring.
    rewrite E2, E4. ring. }
  split; apply (Rmult_eq_reg_r d); auto.
  - replace ((a + c) * d) with (a * d + c * d) by ring. rewrite A, C. unfold d. ring.
  - apply (Rmult_eq_reg_r d); auto. replace ((a * c - b * b) * d * d) with (a * d * (c * d) - b * d * (b * d)) by ring.
    rewrite A, C, B at 1. rewrite B'. unfold d. ring.
Qed.

(** They exist. *)
Theorem principal_curvatures_exist a b c : exists k l x y x' y',
  eigen a b c k x y /\ eigen a b c l x' y' /\ x * y' - y * x' <> 0.
Proof.
  destruct (Req_dec b 0) as [-> | Hb].
  - exists a, c, 1, 0, 0, 1. unfold eigen. lra.
  - set (r := sqrt ((a - c) ^ 2 + 4 * b ^ 2)).
    assert (B : 0 < b * b) by (now apply Rsqr_pos_lt). pose proof (Rle_0_sqr (a - c)) as S. unfold Rsqr in S.
    assert (Hr : r * r = (a - c) ^ 2 + 4 * b ^ 2) by (apply sqrt_sqrt; lra).
    assert (P : 0 < r) by (apply sqrt_lt_R0; lra).
    exists ((a + c + r) / 2), ((a + c - r) / 2), b, ((a + c + r) / 2 - a), b, ((a + c - r) / 2 - a).
    unfold eigen. repeat split; try field; nra.
Qed.
