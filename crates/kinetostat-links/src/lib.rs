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
//! | a section, straight or tapered | [`Shape`], [`cantilever`] |
//!
//! SI units, translations before rotations, as in [`kinetostat`]; files say their units in keys or the
//! caller says them. Memory is bounded: [`MOST_BYTES`], [`MOST_DOFS`], [`MOST_ENVELOPE`].

mod calculix;
mod condense;
mod displacements;
mod dmig;
mod envelope;
mod error;
mod experiment;
mod harwell_boeing;
mod interface;
mod judge;
mod material;
mod matrix_file;
mod nodes;
mod section;
mod superelement;
mod table;
mod taper;
mod text;
mod units;

pub use condense::{Condensed, FreeTest, Question, Tie, condense, free_test};
pub use displacements::{LoadTable, read_displacements, read_loads, unit_loads};
pub use envelope::MOST_ENVELOPE;
pub use error::{Error, Result};
pub use experiment::{Identified, LoadCase, identify};
pub use interface::{RigidFit, RigidRank, rigid_fit, rigid_rank, spider};
pub use judge::{DIRECTIONS, Finding, Grade, Judgement, SYMMETRIC_TO, judge, symmetrised};
pub use material::{MATERIALS, Material, material};
pub use matrix_file::{LinkMatrix, axes_from, read_matrix};
pub use nodes::{Nodes, read_nodes};
pub use section::{Properties, Shape};
pub use superelement::{Dof, MOST_DOFS, Superelement, read_superelement};
pub use table::{in_n_mm, stiffness_table};
pub use taper::{Shear, cantilever, cantilever_by};
pub use text::{MOST_BYTES, Text, number};
pub use units::{UNITS, Units};
