//! Options that say how vibrations are damped.

use clap::Args;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;

use crate::options::number;
use crate::ui::failure::{Answer, Failing, Failure};

/// How vibrations are damped: one law, by name; without one that of the model.
#[derive(Debug, Default, Args)]
pub(crate) struct DampingArgs {
    /// Ratio to critical damping of all modes (0.03 is 3 %), or one for each of the lowest modes, the
    /// last for all above
    #[arg(long, num_args = 1.., value_name = "RATIO", allow_negative_numbers = true, value_parser = number, help_heading = "Damping", conflicts_with_all = ["rayleigh", "loss_factor", "viscous"])]
    pub(crate) damping: Vec<f64>,
    /// C = A M + B K: A in 1/s, B in s
    #[arg(long, num_args = 2, value_names = ["A", "B"], allow_negative_numbers = true, value_parser = number, help_heading = "Damping", conflicts_with_all = ["loss_factor", "viscous"])]
    pub(crate) rayleigh: Option<Vec<f64>>,
    /// Loss factor of all springs, structural damping
    #[arg(long, value_name = "ETA", allow_negative_numbers = true, value_parser = number, help_heading = "Damping", conflicts_with = "viscous")]
    pub(crate) loss_factor: Option<f64>,
    /// Dampers at joints and springs by name, N s/m or N m s/rad, as in "joint 1"=900
    #[arg(long, num_args = 1.., value_name = "JOINT=VALUE", help_heading = "Damping")]
    pub(crate) viscous: Vec<String>,
}

impl DampingArgs {
    /// The law; that of the model without any option.
    pub(crate) fn law(&self, of_model: &Damping) -> Answer<Damping> {
        let law = if let [ratio] = self.damping.as_slice() {
            Damping::Ratio(*ratio)
        } else if !self.damping.is_empty() {
            Damping::Ratios(self.damping.clone())
        } else if let Some([mass, stiffness]) = self.rayleigh.as_deref() {
            Damping::Rayleigh {
                mass_per_s: *mass,
                stiffness_s: *stiffness,
            }
        } else if let Some(loss_factor) = self.loss_factor {
            Damping::Structural { loss_factor }
        } else if self.viscous.is_empty() {
            of_model.clone()
        } else {
            let read = |text: &String| -> Answer<(String, f64)> {
                let (name, value) = text.rsplit_once('=').ok_or_else(|| wrong_damper(text))?;
                let value = number(value).map_err(|_| wrong_damper(text))?;
                Ok((name.trim_matches('"').to_owned(), value))
            };
            Damping::Viscous(self.viscous.iter().map(read).collect::<Answer<_>>()?)
        };
        law.check()
            .map_err(|error| ErrorCode::Value.failure(error))?;
        Ok(law)
    }
}

fn wrong_damper(text: &str) -> Failure {
    ErrorCode::Value.failure(format!(
        "--viscous {text}: a joint and a number are needed, as in joint_1=900"
    ))
}

/// The law in words.
pub(crate) fn words(damping: &Damping) -> String {
    match damping {
        Damping::Undamped => "none".to_owned(),
        Damping::Ratio(ratio) => format!("{ratio} of critical in every mode"),
        Damping::Ratios(list) => format!("ratios {list:?} of the modes, the last for all above"),
        Damping::Rayleigh {
            mass_per_s,
            stiffness_s,
        } => format!("Rayleigh, {mass_per_s} 1/s times mass and {stiffness_s} s times stiffness"),
        Damping::Structural { loss_factor } => {
            format!("structural, loss factor {loss_factor} of all springs")
        }
        Damping::Viscous(list) => {
            let each = list.iter().map(|(name, c)| format!("{name}={c}"));
            format!("viscous: {}", each.collect::<Vec<_>>().join(", "))
        }
    }
}
