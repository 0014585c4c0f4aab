//! Forms of the report and of textbooks that no engine needs: for those who check, teach or simplify.
//!
//! The blocks of a chain's tangent and the three ways to its stiffness [R 3.7-3.16, 4.27-4.29], the elimination of single
//! passive joints with the cases of Tables 3.1-3.3, the report's own iteration [R 4.15-4.16] and its criterion of a
//! shape [R 5.16-5.21].
//!
//! Takes chains and their problems, gives what the engines give, by the report's own steps.
//!
//! ```text
//! K_C = K_C^0 - K_C^0 J_q (J_q^T K_C^0 J_q)^-1 J_q^T K_C^0                                              [R 3.10-3.16]
//! theta <- K^-1 (J^T F + ...), q by the bordered system, loads and Jacobians lagged                     [R 4.15-4.16]
//! ```

pub(crate) mod chain_blocks;
pub(crate) mod elimination;
pub(crate) mod passive_rules;
pub(crate) mod report_iteration;
pub(crate) mod shape_criterion;

pub use chain_blocks::{Applied, ChainBlocks, Inapplicable};
pub use elimination::{LoadedClosedForm, Recursion};
pub use passive_rules::{
    Axis, Elimination, eliminate_passive, planar_beam, planar_with_hinge_at_end,
    planar_with_slide_along_x, planar_with_slide_along_y, with_hinge_at, with_hinge_at_end,
    with_hinge_at_root, with_slide, with_spherical_joint_at_end, with_universal_joint_at_end,
};
pub use report_iteration::{
    ChainState, IterationOutcome, IterationSettings, ReportIteration, newton_iteration,
    report_iteration,
};
pub use shape_criterion::{ShapeCriterion, shape_criterion};
