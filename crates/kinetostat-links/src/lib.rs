//! Stiffness of links from other programs: 6 x 6 matrices, displacement tables, superelements; and
//! sections of beams for those who have neither.
//!
//! A link of a robot is described by the 6 x 6 stiffness of its far end with its near end fixed. This
//! crate gets it out of the files of finite element programs, checks that it is one, and says in words
//! what is not. It knows no robot.
//!
//! | from | by |
//! |---|---|
//! | CSV or JSON with a 6 x 6 matrix | [`read_matrix`] |
//! | displacements of the interface under six loads | [`read_displacements`], [`identify`] |
//! | Nastran `DMIG`, CalculiX `.mtx` and `.sti`, Ansys Harwell-Boeing | [`read_superelement`], [`condense`] |
//! | a section, straight or tapered | [`SectionShape`], [`cantilever`] |
//!
//! SI units, translations before rotations, as in [`kinetostat`]; files say their units in keys or the
//! caller says them. Memory is bounded: [`MOST_BYTES`], [`MOST_DOFS`], [`MOST_ENVELOPE`].

mod beam;
mod condensation;
mod error;
mod experiment;
mod files;
mod interface;
#[doc(hidden)]
pub mod internal;
mod stiffness_check;
mod superelement;
mod text;
mod units;

pub use beam::section::{Properties, SectionShape};
pub use beam::taper::{MATERIALS, Material, Shear, cantilever, cantilever_by, material};
pub use condensation::condense::{CondensationRequest, Condensed, Tie, condense};
pub use condensation::envelope::MOST_ENVELOPE;
pub use condensation::free_test::{FreeTest, free_test};
pub use error::{Error, LinkErrorKind, Result};
pub use experiment::{Identified, LoadCase, identify};
pub use files::displacements::{LoadTable, read_displacements, read_loads, unit_loads};
pub use files::matrix::{LinkMatrix, axes_from, read_matrix};
pub use files::nodes::{Nodes, read_nodes};
pub use files::read_superelement;
pub use interface::{RigidFit, RigidRank, rigid_fit, rigid_rank, spider};
pub use stiffness_check::{
    DIRECTIONS, Finding, Grade, SYMMETRIC_TO, StiffnessCheck, check_stiffness, symmetrised,
};
pub use superelement::{Dof, MOST_DOFS, Superelement};
pub use text::{MOST_BYTES, Text, number};
pub use units::{UNITS, Units, in_n_mm, stiffness_table};
