//! Options that say a place.

use clap::Args;

use crate::options::number;

/// A place in the workspace.
#[derive(Debug, Default, Args)]
pub(crate) struct PlaceArgs {
    /// Place of the tool's tip in base axes, mm; home without it
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) at: Option<Vec<f64>>,
    /// Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90, or the word
    /// follows: the one nearest to that at home which the machine can have there. Without it, the
    /// orientation at home; it follows where the machine cannot hold one
    #[arg(long, value_name = "CONVENTION=A,B,C", conflicts_with_all = ["joints", "controller", "pendant"])]
    pub(crate) rotation: Option<String>,
    /// The place by the model's joint values instead, deg and mm, as in shoulder=30 rail=250; joints
    /// that are not named stay at home
    #[arg(long, num_args = 1.., value_name = "JOINT=VALUE", value_delimiter = ',', conflicts_with = "at")]
    pub(crate) joints: Vec<String>,
    /// The same by what the controller shows, as in J1=10 J2=31.324; the model declares it
    /// in its section controller
    #[arg(long, num_args = 1.., value_name = "AXIS=VALUE", value_delimiter = ',', conflicts_with_all = ["at", "joints"])]
    pub(crate) controller: Vec<String>,
    /// The name of `--controller` before; it is taken for one version more, with a warning
    #[arg(long, hide = true, num_args = 1.., value_name = "AXIS=VALUE", value_delimiter = ',', conflicts_with_all = ["at", "joints", "controller"])]
    pub(crate) pendant: Vec<String>,
}

impl PlaceArgs {
    /// One place is requested.
    pub(crate) fn given(&self) -> bool {
        self.at.is_some()
            || self.rotation.is_some()
            || !self.joints.is_empty()
            || !self.controller.is_empty()
            || !self.pendant.is_empty()
    }
}
