//! Options of `kinetostat import matrix` and `kinetostat import link-displacements`.

use std::path::PathBuf;

use clap::Args;

use crate::options::{EXIT_CODES, number};

const MATRIX_HELP: &str = "\
Examples:
  kinetostat import matrix forearm.csv --name forearm
      six rows of six numbers; the header says units and order:
      stiffness_n_mm_rad,x,y,z,rx,ry,rz
  kinetostat import matrix link.sti --dofs link.dof --nodes link.inp \\
      --units n-mm --interface TIP --fixed ROOT --end-mm 600 0 0
      the stiffness matrix of a mesh that CalculiX stored
  kinetostat import matrix link.pch --nodes link.bdf --units n-mm \\
      --interface 101 --fixed 100
      a superelement of Nastran (DMIG)

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";

/// The stiffness of a link from a matrix: 6 x 6 (CSV, JSON), or of a mesh's interfaces
///
/// Writes a table [stiffness.NAME] for a model file. A 6 x 6 says its units in its header. A matrix of
/// many degrees of freedom (Nastran DMIG, CalculiX .sti or .mtx, Harwell-Boeing) is condensed: the nodes
/// of --interface become one rigid body at the link's end (or move it by their average), those of --fixed
/// are held. What is not a stiffness is refused in words.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = MATRIX_HELP)]
pub(crate) struct MatrixArgs {
    /// File with the matrix: CSV or JSON (6 x 6), DMIG, .sti, .mtx or Harwell-Boeing
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Which node and direction each row is: the .dof file of CalculiX, the mapping file of Ansys
    #[arg(long, value_name = "FILE", requires = "interface")]
    pub(crate) dofs: Option<PathBuf>,
    /// Which matrix, where the file has several (DMIG)
    #[arg(long, value_name = "NAME", requires = "interface")]
    pub(crate) matrix: Option<String>,
    /// Nodes of the end that moves: numbers as in 12,13,14 or the name of a set of the mesh
    #[arg(long, value_name = "NODES")]
    pub(crate) interface: Option<String>,
    /// Nodes of the end that is held; none if the matrix is of a link held already
    #[arg(long, value_name = "NODES", requires = "interface")]
    pub(crate) fixed: Option<String>,
    /// The interface may warp: the end moves by the average of its nodes and spreads its load over them
    /// (RBE3); without it they are tied rigidly (RBE2)
    #[arg(long, requires = "interface")]
    pub(crate) averaged: bool,
    /// The link's end in the mesh, mm; the middle of the interface's nodes without it
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, requires = "interface")]
    pub(crate) end_mm: Option<Vec<f64>>,
    /// The matrix is not symmetric because of noise: take its symmetric part, and say so in the table
    #[arg(long)]
    pub(crate) symmetrise: bool,
    #[command(flatten)]
    pub(crate) mesh: MeshArgs,
    #[command(flatten)]
    pub(crate) table: TableArgs,
}

/// The stiffness of a link from displacements of its interface under six loads
///
/// FILE has the columns case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm (units mm, m; displacements also um),
/// or is the .dat file of CalculiX with one step per case. A rigid motion is fitted to the nodes in
/// each case, the interface may warp (an averaged interface); the compliance, how sure it is and what of
/// it is not symmetric are reported.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct DisplacementsArgs {
    /// File with the displacements: CSV, or the .dat file of CalculiX
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Where the loads act and the stiffness belongs: the link's end in the mesh, mm
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, required = true)]
    pub(crate) end_mm: Vec<f64>,
    /// Loads of the cases (CSV): case,fx_n,fy_n,fz_n,mx_n_mm,my_n_mm,mz_n_mm
    #[arg(long, value_name = "FILE")]
    pub(crate) loads: Option<PathBuf>,
    /// Force of the cases fx, fy, fz, N
    #[arg(long, value_name = "F", default_value = "1", allow_negative_numbers = true, value_parser = number, conflicts_with = "loads")]
    pub(crate) force_n: f64,
    /// Moment of the cases mx, my, mz, N mm
    #[arg(long, value_name = "M", default_value = "1", allow_negative_numbers = true, value_parser = number, conflicts_with = "loads")]
    pub(crate) moment_n_mm: f64,
    /// Take entries of the compliance for zero that the noise hides (less than twice their deviation)
    #[arg(long)]
    pub(crate) filter: bool,
    #[command(flatten)]
    pub(crate) mesh: MeshArgs,
    #[command(flatten)]
    pub(crate) table: TableArgs,
}

/// What a file does not say: units, places, axes.
#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    /// Units of a file that has none: n-mm, n-m, kn-mm, kn-m, lbf-in
    #[arg(long, value_name = "UNITS")]
    pub(crate) units: Option<String>,
    /// Where the nodes are, and their sets: a mesh (*NODE or GRID), or CSV with node,x_mm,y_mm,z_mm
    #[arg(long, value_name = "FILE")]
    pub(crate) nodes: Option<PathBuf>,
    /// Direction of the link's x axis in the mesh [default: 1 0 0]
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) x_axis: Option<Vec<f64>>,
    /// Direction that the link's y axis leans to in the mesh [default: 0 1 0]
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) y_axis: Option<Vec<f64>>,
}

/// Where the table goes.
#[derive(Debug, Args)]
pub(crate) struct TableArgs {
    /// Name of the table [stiffness.NAME]; the file's name without it
    #[arg(long, value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// The table; without it, it goes to the standard output
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Print what was found as JSON; the text goes to the standard error
    #[arg(long, help_heading = "Outputs")]
    pub(crate) json: bool,
}
