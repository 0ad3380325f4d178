(** A theorem whose hypotheses nothing fulfils says nothing: here is something for each of them. *)
From Coq Require Import Reals Lra Lia List.
From Semispline Require Import Sums BSplines Derivatives EndDerivatives Independence Contact Mirror Surfaces Smoothness
  Insertion Polynomials Geometry Energy Division Printed.
Import ListNotations.
Open Scope R_scope.

(** U and W of the counterexamples, a line's knots T, and D with a double knot. *)
Definition T : nat -> R := vector [0; 0; 1; 1].
Definition D : nat -> R := vector [0; 0; 0; 0; 1/2; 1/2; 1; 1; 1; 1].

Lemma T_ascending : ascending T.
Proof. apply vector_ascending. cbn. lra. Qed.
Lemma D_ascending : ascending D.
Proof. apply vector_ascending. cbn. lra. Qed.
Lemma T_clamped : clamped T 1.
Proof. split; [intros [|[|[|i]]] Hi; try reflexivity; exfalso; lia|cbn; lra]. Qed.
Lemma T_clamped_end : clamped_end T 1 1.
Proof. split; [intros [|[|[|i]]] Hi; try reflexivity; exfalso; lia|cbn; lra]. Qed.
Lemma T_proper : proper T 1 1.
Proof. intros [|[|j]] Hj; try (cbn; lra); lia. Qed.
Lemma U_proper : proper U 3 5.
Proof. intros [|[|[|[|[|[|j]]]]]] Hj; try (cbn; lra); lia. Qed.
Lemma D_repeated : repeated D 3 5 (1/2).
Proof.
  split; [lia|split].
  - intros [|[|[|[|[|[|i]]]]]] Hi; try lia; reflexivity.
  - cbn. lra.
Qed.
Lemma in_first_span : span U 3 (1/6).
Proof. unfold span, U, vector. cbn. lra. Qed.

Local Ltac known := auto using U_ascending, W_ascending, T_ascending, D_ascending, U_clamped, W_clamped, T_clamped,
  U_clamped_end, T_clamped_end, T_proper, U_proper, D_repeated, in_first_span.

(** Functions and curves. *)
Example local_support_met : N U 3 0 (-1) = 0.
Proof. apply local_support; [known|left; cbn; lra]. Qed.
Example non_negative_met : 0 <= N U 3 1 (1/6).
Proof. apply non_negative. known. Qed.
Example partition_of_unity_met : sum 6 (fun i => N U 3 i (1/2)) = 1.
Proof. apply partition_of_unity; [known|lia|cbn; lra]. Qed.
Example positive_inside_met : 0 < N U 3 1 (1/6).
Proof. apply (positive_inside U U_ascending 3 1 3); [cbn; lra|lia]. Qed.
Example own_knots_met : N U 3 0 (1/6) = N (vector [0; 0; 0; 0; 1/3; 2; 3; 4]) 3 0 (1/6).
Proof. apply own_knots. intros [|[|[|[|[|j]]]]] Hj; try reflexivity; lia. Qed.
Example cox_derivative_met := cox_derivative (delta 3) U U_ascending 2 1 (1/6).
Example spline_derivative_met P := spline_derivative U 2 4 P 3 U_ascending ltac:(lia).
Example insertion_met := insertion U 3 (1/6) U_ascending in_first_span 3 2 (1/7).
Example same_curve_met P := same_curve U 3 (1/6) U_ascending in_first_span 5 3 P (1/7).
Example smooth_met P : exists g, derivatives_on (around D 3 5) 1 (spline 5 D 3 P) g /\
  limit1_in g (around D 3 5) (g (1/2)) (1/2).
Proof. apply smooth_at_a_knot; known; lia. Qed.
Example no_smoother_met : exists P, piece_end 2 3 5 D 3 P (1/2) <> piece_end 2 5 5 D 3 P (1/2).
Proof. apply no_smoother; known; lia. Qed.
Example piece_end_met P := piece_end_is 2 3 5 D 3 P D_ascending ltac:(lia) ltac:(lia).
Example de_boor_met P := de_boor U 3 5 3 (1/6) P U_ascending ltac:(lia) in_first_span.
Example independent_met P := independent U 3 5 P U_ascending U_clamped U_clamped_end U_proper.
Example independent_on_span_met P := independent_on_span 3 U 5 P 3 U_ascending ltac:(lia) ltac:(cbn; lra).
Example same_points_met P Q := same_points U 3 5 P Q U_ascending U_clamped U_clamped_end U_proper.
Example same_on_span_met P Q x : span U 3 x -> span D 3 x ->
  (forall y, In y [1/10; 1/9; 1/8; 1/7] -> spline 5 U 3 P y = spline 5 D 3 Q y) -> spline 5 U 3 P x = spline 5 D 3 Q x.
Proof.
  intros H1 H2 H. apply (same_on_span U D 3 5 5 P Q 3 3 [1/10; 1/9; 1/8; 1/7]); known.
  - repeat constructor; cbn; intuition lra.
  - intros y Hy. unfold span, U, D, vector. cbn in *. intuition lra.
Qed.

(** Ends, contact, and the conditions. *)
Example start_derivative_is_met P := start_derivative_is 2 5 U 3 P U_ascending U_clamped ltac:(lia).
Example start_derivative_iff_met P y := start_derivative_iff 2 5 U 3 P y U_ascending U_clamped ltac:(lia).
Example end_derivatives_met P := end_derivatives 2 U 3 P U_ascending U_clamped.
Example end_derivative_iff_met P y := end_derivative_iff 2 5 U 3 P y U_ascending U_clamped_end ltac:(lia).
Example start_value_met P := start_value 5 U 3 P U_ascending U_clamped.
Example rows_met P := rows 3 U 3 P U_ascending U_clamped ltac:(lia).
Example rows_iff_met P d := rows_iff 3 U 3 P d U_ascending U_clamped ltac:(lia).
Example end_contact_iff_met b P Q := end_contact_iff 2 b 5 U 3 P 5 W 3 Q U_ascending U_clamped_end ltac:(lia).
Example contact_rows_by_met c P Q := contact_rows_by c 3 5 U 3 P 5 W 3 Q U_ascending U_clamped W_ascending W_clamped
  ltac:(lia) ltac:(lia).
Example contact_rows_met a P Q : contact 3 a 5 U 3 P 5 W 3 Q <-> _ :=
  contact_rows 3 a 5 U 3 P 5 W 3 Q U_ascending U_clamped W_ascending W_clamped ltac:(lia) ltac:(lia).
Example contact_general_met g P Q := contact_general_rows 3 g 5 U 3 P 5 W 3 Q U_ascending U_clamped W_ascending W_clamped
  ltac:(lia) ltac:(lia).
Example condition_1_1_met := condition_1_1 5 U 3 5 W 3 U_ascending U_clamped W_ascending W_clamped ltac:(lia) ltac:(lia).
Example condition_2_1_met := condition_2_1 5 U 3 5 W 3 U_ascending U_clamped W_ascending W_clamped ltac:(lia) ltac:(lia).
Example condition_3_1_met := condition_3_1 5 U 3 5 W 3 U_ascending U_clamped W_ascending W_clamped ltac:(lia) ltac:(lia).
Example condition_2_2_met := condition_2_2 5 U 3 5 W 3 U_ascending U_clamped_end W_ascending W_clamped ltac:(lia) ltac:(lia).
Example condition_3_2_met := condition_3_2 5 U 3 5 W 3 U_ascending U_clamped_end W_ascending W_clamped ltac:(lia) ltac:(lia).
Example printed_2_2_cubic_met be P Q := printed_2_2_cubic 5 U 5 W 3 be P Q U_ascending U_clamped_end W_ascending W_clamped
  ltac:(lia) ltac:(lia).

(** Of [printed_3_1_iff], [printed_3_1_squares_iff], [printed_3_2_iff] and [printed_3_2_squares_iff]: the blends of
    [printed_3_1_fails], [printed_3_1_squares_fails], [printed_3_2_fails] and [printed_3_2_squares_fails], for every alpha
    other than 0; of [printed_3_1_curvature] and [printed_3_1_squares_curvature]: [a_ruled_base_exists]. *)
Example blends_met := (printed_3_1_fails 1 R1_neq_R0, printed_3_1_squares_fails 1 R1_neq_R0,
  printed_3_2_fails 1 R1_neq_R0, printed_3_2_squares_fails 1 R1_neq_R0, a_ruled_base_exists 1 R1_neq_R0).
Example printed_17_iff_met : exists P Q, P O = Q O /\ printed_17 1 3 3 (1/3) 1 (P O) (P 1%nat) (Q O) (Q 1%nat).
Proof. exists (fun i => nth i [0; 1/3] 0), linear. unfold printed_17. cbn. split; [reflexivity|field]. Qed.
Example equation_2_1_met : exists P, contact 1 (1 ^ 2) 5 U 3 P 5 W 3 curved.
Proof. destruct (printed_3_1_fails 1 ltac:(lra)) as (P & C & _). now exists P. Qed.

(** Surfaces. *)
Example equation_3_met P := equation_3 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 P (1/2) (1/2).
Example surface_met P : 0 <= N T 1 0 (1/2) * N U 3 1 (1/2)
  /\ surface 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 (fun _ _ => 1) (1/2) (1/2) = 1
  /\ surface 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 (fun i j => 2 * P i j + 3) (1/2) (1/2)
    = 2 * surface 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 P (1/2) (1/2) + 3.
Proof.
  repeat split.
  - exact (weights_non_negative U 3 (fun _ => T) 1 U_ascending (fun _ => T_ascending) (1/2) (1/2) 1 0).
  - apply weights_add_up; intros; known; try lia; cbn; lra.
  - apply affine_invariance; intros; known; try lia; cbn; lra.
Qed.
Example convex_hull_met : 0 <= surface 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 (fun i j => INR i) (1/2) (1/2).
Proof. apply convex_hull; intros; known; try lia; try (cbn; lra). apply pos_INR. Qed.
Example locality_met : surface 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 (fun i j => INR i) (1/6) (1/2)
  = surface 5 U 3 (fun _ => 1%nat) (fun _ => T) 1
    (fun i j => if Nat.eq_dec i 5 then if Nat.eq_dec j 0 then 7 else INR i else INR i) (1/6) (1/2).
Proof.
  apply (locality 5 U 3 (fun _ => 1%nat) (fun _ => T) 1 U_ascending (fun _ => T_ascending) (1/6) (1/2) _ _ 5 0).
  - intros i j H. destruct (Nat.eq_dec i 5), (Nat.eq_dec j 0); tauto.
  - left. cbn. lra.
Qed.
Example contact_of_surfaces_met P Q := contact_of_surfaces (fun k => (- 1) ^ k) 2 5 U 3
  (fun i v => spline 1 T 1 (P i) v) 5 W 3 1 T 1 P Q U_ascending U_clamped W_ascending W_clamped ltac:(lia) ltac:(lia)
  T_ascending T_clamped T_clamped_end T_proper (fun _ _ _ => eq_refl).

(** Bezier patches. *)
Example bern_step_met x := bern_step 3 1 x ltac:(lia).
Example bern_product_met u := bern_product 2 3 1 u [0%nat; 2%nat] ltac:(lia) ltac:(repeat constructor).
Example equation_5_met t := equation_5_abscissa 3 t ltac:(lia).

(** Geometry. *)
Example one_tangent_plane_met :
  (forall x, in_plane (Geometry.V 1 0 0) (Geometry.V 1 1 0) x <-> in_plane (Geometry.V 0 1 0) (Geometry.V 2 0 0) x) <->
  exists c, cross (Geometry.V 1 0 0) (Geometry.V 1 1 0) = scale c (cross (Geometry.V 0 1 0) (Geometry.V 2 0 0)).
Proof. apply one_tangent_plane; intro E; injection E; lra. Qed.
Example curvatures_agree_met L M N' := curvatures_agree 1 0 1 L M N' L M N'
  ltac:(unfold form; intros u v [H|H]; pose proof (Rle_0_sqr u); pose proof (Rle_0_sqr v); unfold Rsqr in *; nra).
Example principal_curvatures_met := principal_curvatures 2 0 3 2 3 1 0 0 1
  ltac:(unfold eigen; lra) ltac:(unfold eigen; lra) ltac:(lra).

(** Energy. *)
Example zero_energy_met (pr : Riemann_integrable (fun x => fct_cte 0 x * fct_cte 0 x) 0 1) :
  RiemannInt pr = 0 -> fct_cte 0 (1/2) = 0.
Proof.
  intro H. apply (zero_energy (fct_cte 0) 0 1 pr); try lra; try exact H.
  intros. apply continuity_const. now intros ? ?.
Qed.
Example product_of_integrals_met :=
  product_of_integrals (fct_cte 2) (fct_cte 3) 0 1 0 1 (RiemannInt_P14 0 1 2) (RiemannInt_P14 0 1 3) ltac:(lra) ltac:(lra).
Example half_slope_met x := half_slope 2 (fun _ _ => 1) (fun _ => 1) (fun _ _ => eq_refl) x 1 1 ltac:(lia) ltac:(lra).
Example least_energy_met d : energy 1 (fun _ _ => 1) (fun _ => 1) (fun _ => -1) <=
  energy 1 (fun _ _ => 1) (fun _ => 1) (fun i => -1 + d i).
Proof.
  apply (least_energy 1 (fun _ _ => 1) (fun _ => 1) (fun _ _ => eq_refl) (fun _ => -1)).
  - intro e. unfold bilinear. cbn. pose proof (Rle_0_sqr (e O)). unfold Rsqr in *. lra.
  - intros. unfold row. cbn. ring.
Qed.
Example expansion_met x d := expansion 1 (fun _ _ => 1) (fun _ => 1) (fun _ _ => eq_refl) x d.
Lemma zero_slope x : derivable_pt_lim (fun _ => 0) x 0.
Proof. apply derivable_pt_lim_const. Qed.
Example cubic_is_least_met := cubic_is_least (fun _ => 0) (fun _ => 0) (fun _ => 0) 1 0 0 0 0 Rlt_0_1 zero_slope zero_slope
  ltac:(apply continuity_const; now intros ? ?) ltac:(cbn; ring) ltac:(cbn; ring) ltac:(cbn; ring) ltac:(cbn; ring).
Example powers_taken_away_met := powers_taken_away 3 (fun _ => exp) (fun _ x => derivable_pt_lim_exp x).
Example slope_not_positive_met : -1 <= 0.
Proof.
  apply (slope_not_positive (fun x => -1 * x) 0).
  - apply (derivable_value _ _ (-1 * 1)); [|ring]. apply (derivable_pt_lim_scal id), derivable_pt_lim_id.
  - exists 1. split; [lra|]. intros. lra.
Qed.
Example slope_of_power_met := slope_of_power 2 3 ltac:(lra).

(** Polynomials: the constants of a circle, and nothing but zero for y'' = - y. *)
Lemma polynomial_constant c : polynomial 1 (fun _ => c).
Proof. exists (fun _ => c). intro. cbn. ring. Qed.
Example too_many_zeros_met x : (fun y : R => 0 * y) x = 0.
Proof.
  apply (too_many_zeros 1 (fun y => 0 * y) [2]).
  - exists (fun _ => 0). intro. cbn. ring.
  - repeat constructor. now intros [].
  - reflexivity.
  - intros. ring.
Qed.
Example bounded_is_constant_met x := bounded_is_constant 1 (fun _ => 3) 3 (polynomial_constant 3)
  ltac:(intros; rewrite Rabs_pos_eq; lra) x.
Example none_on_a_circle_met t := none_on_a_circle 1 (fun _ => 3) (fun _ => 4) 5 (polynomial_constant 3)
  (polynomial_constant 4) (fun _ => ltac:(cbv beta; ring)) t.
Example no_rational_solution_met x := no_rational_solution 1 (fun _ => 0) (fun _ => 1) (fun _ => 0) (fun _ => 0) 0
  (polynomial_constant 0) (fun _ _ => R1_neq_R0) (fun _ _ => ltac:(cbv beta; field)) (fun x _ => derivable_pt_lim_const 0 x)
  (fun x _ => ltac:(cbv beta; rewrite Ropp_0; apply derivable_pt_lim_const)) x.
