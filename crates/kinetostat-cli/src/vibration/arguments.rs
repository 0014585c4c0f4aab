//! Options that say which machine vibrates, where, under which load.

use clap::Args;

use crate::options::number;
use crate::place::arguments::PlaceArgs;

/// The machine, its place and its load.
#[derive(Debug, Args)]
pub(crate) struct VibrationArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Mass that the flange carries beside that of the model, kg: spindle and tool, as `mass_kg` of a
    /// job's tool
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_mass_kg: Option<f64>,
    /// Its centre in the frame of the flange, mm; halfway to the tip without it
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], requires = "tool_mass_kg", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_centre_of_mass_mm: Option<Vec<f64>>,
    /// Its inertia about that centre in axes of the flange, kg m^2; a point without it. Products carry
    /// their minus sign
    #[arg(long, num_args = 6, value_names = ["XX", "YY", "ZZ", "XY", "XZ", "YZ"], requires = "tool_mass_kg", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_inertia_kg_m2: Option<Vec<f64>>,
    /// Constant force on the tool's tip, N, about whose equilibrium the machine vibrates
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Constant moment on the tool about its tip, N m
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
}
