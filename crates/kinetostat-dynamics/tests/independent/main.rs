//! Elasto-dynamics against programs that were not written for it, and what must not depend on how a machine is described.
//!
//! The traps of dynamics.md, section 13, and the tests that would fall into them (`d`: kinetostat-dynamics, `tests/dynamics`;
//! `i`: this folder; `c`: kinetostat-chatter, `tests/chatter`):
//!
//! | trap | test |
//! |---|---|
//! | 1 rigid links as mass of elastic legs | `i traps::rigid_links_are_no_mass_model_of_elastic_legs`, `d beams::orders_of_convergence` |
//! | 2 zeroth order as a bound | `c arm::exact_limits_over_the_speed` |
//! | 3 multipliers and `hat(f) hat(s)` in loops | `i platform::a_loaded_machine_off_every_axis`, `i exudyn`, `d platforms::loaded_hexapod`, `opposed_legs_preloaded` |
//! | 4 truncation without residual flexibility | `d responses::truncation_needs_residual_flexibility`, `c traps::residual_flexibility_belongs_to_the_lobes` |
//! | 5 semi-discretisation of fixed steps; islands | `c traps::semi_discretisation_tends_to_the_collocation`, `islands_are_found` |
//! | 6 absolute values of `w^2` | `d arms::pendulums_hang_and_stand`, `platforms::opposed_legs_preloaded` |
//! | 7 `H` or weight missing on slices, `M` at the nominal posture | `i platform::a_loaded_machine_off_every_axis`, `d arms::frame_converges`, `derivatives::weight_of_slices_changes_as_its_tangent_says` |
//! | 8 neutral directions | `i invariants::a_massless_joint_changes_nothing`, `d platforms::hexapods_without_load` |
//! | 9 dead moments on one segment | `d circulatory::dead_end_moments_flutter_from_two_segments_on` |
//! | 10 rotors on the wrong side | `i traps::rotors_sit_before_the_transmission` |
//! | 11 loss factor on `H` | `d responses::the_loss_factor_multiplies_the_material_alone` |
//! | 12 `Kr` and `Kr Kt`, degrees, up and down, hand of the frame | `c traps::a_ratio_is_no_coefficient`, `up_and_down_are_not_mirrored`, `frames_are_right_handed`; `tests/afresh.rs` there |
//! | 13 mm, N/mm2, tonnes | `i invariants::units_do_not_matter`, `c traps::coefficients_are_in_si_units` |
//! | 14 an extensible column and the inextensible formula | `i traps::an_extensible_column_is_not_that_of_the_formula` |

#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(
    clippy::print_stdout,
    reason = "figures, and tests that say that they were skipped"
)]

mod common;
mod exudyn;
mod invariants;
mod opensees;
mod platform;
mod scripts;
mod traps;
