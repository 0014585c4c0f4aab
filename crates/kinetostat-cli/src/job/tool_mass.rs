//! Mass of the tool, which the machine carries beside its own.

use std::ops::RangeInclusive;

use kinetostat::Pose;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::{Model, inertia_of_body};
use nalgebra::{Matrix3, Vector3};
use serde_spanned::Spanned;

use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing};

/// Mass of a tool, its centre in the frame of the flange and its inertia about that centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ToolMass {
    pub(crate) mass_kg: f64,
    pub(crate) centre_mm: Vector3<f64>,
    /// Axes of the flange, kg m^2; zero for a point.
    pub(crate) inertia: Matrix3<f64>,
}

/// Allowed mass of spindle and tool, kg.
pub(crate) const MASSES_KG: RangeInclusive<f64> = 1e-3..=5000.0;

/// Mass of a tool as a table of the job states it.
pub(crate) struct StatedMass<'a> {
    pub(crate) mass: Option<&'a Spanned<f64>>,
    pub(crate) centre: Option<&'a Spanned<[f64; 3]>>,
    pub(crate) inertia: Option<&'a Spanned<[[f64; 3]; 3]>>,
}

impl StatedMass<'_> {
    /// The mass on a model's flange, with its centre halfway to the tip where none is stated.
    pub(crate) fn read(&self, j: &JobFile, model: &Model, tool: &Pose) -> Answer<Option<ToolMass>> {
        let Some(mass) = self.mass else {
            return match (self.centre, self.inertia) {
                (Some(at), _) => Err(j.error(
                    at,
                    "the tool has a centre of mass and no mass",
                    "write mass_kg, too",
                )),
                (None, Some(at)) => Err(j.error(
                    at,
                    "the tool has an inertia and no mass",
                    "write mass_kg, too",
                )),
                (None, None) => Ok(None),
            };
        };
        if !MASSES_KG.contains(mass.get_ref()) {
            return Err(j.error(
                mass,
                "the mass of a tool is from 0.001 to 5000 kg",
                "write it in kg",
            ));
        }
        if model.document.mechanism.gravity_m_per_s2.is_none() {
            return Err(j.error(
                mass,
                "the tool has a mass, and the model states no gravity",
                "write gravity_m_per_s2 = [0, 0, -9.81] under [mechanism] of the model (base axes), or [0, 0, 0] to leave the weights out",
            ));
        }
        let far = |c: &&Spanned<[f64; 3]>| !c.get_ref().iter().all(|x| x.abs() <= 1e5);
        if let Some(at) = self.centre.filter(far) {
            return Err(j.error(
                at,
                "the centre of mass lies more than 100 m away",
                "write it in mm from the flange",
            ));
        }
        let inertia = self.inertia.map(|at| {
            inertia_of_body(*at.get_ref()).map_err(|(message, help)| j.error(at, &message, &help))
        });
        let halfway = 500.0 * tool.translation.vector;
        Ok(Some(ToolMass {
            mass_kg: *mass.get_ref(),
            centre_mm: self.centre.map_or(halfway, |c| (*c.get_ref()).into()),
            inertia: inertia.transpose()?.unwrap_or_default(),
        }))
    }
}

/// The machine that carries a tool of this mass: statics, modes, chatter and placements are those of the sum.
pub(crate) fn carrying(model: &Model, tool: ToolMass) -> Answer<Model> {
    let mechanism = &model.mechanism;
    let name = &mechanism.platforms()[mechanism.tool()].name;
    let mut document = model.document.clone();
    let Some(own) = document.platform.iter_mut().find(|p| p.name == *name) else {
        return Err(ErrorCode::ModelUnsuited.failure(format!(
                "the model has no platform '{name}' that could carry the tool: leave mass_kg out of [tool]"
            ),
        ));
    };
    let own_mass = own.mass_kg.unwrap_or(0.0);
    let in_mm = own.centre_of_mass_mm.map(Vector3::from);
    let in_m = own.centre_of_mass_m.map(|c| 1e3 * Vector3::from(c));
    let own_centre = in_mm.or(in_m).unwrap_or_default();
    let mass = own_mass + tool.mass_kg;
    let centre = (own_mass * own_centre + tool.mass_kg * tool.centre_mm) / mass;
    if own_mass > 0.0 || own.inertia_kg_m2.is_some() || tool.inertia != Matrix3::zeros() {
        let rows = own.inertia_kg_m2.unwrap_or_default();
        let mut inertia = tool.inertia + Matrix3::from_fn(|i, k| rows[i][k]);
        for (mass, from) in [(own_mass, own_centre), (tool.mass_kg, tool.centre_mm)] {
            let d = 1e-3 * (from - centre);
            inertia += mass * (Matrix3::identity() * d.norm_squared() - d * d.transpose());
        }
        own.inertia_kg_m2 = Some([0, 1, 2].map(|i| inertia.row(i).transpose().into()));
    }
    own.mass_kg = Some(mass);
    own.centre_of_mass_mm = Some(centre.into());
    own.centre_of_mass_m = None;
    Ok(Model::from_document(
        &document,
        &format!("{} with the mass of its tool", model.name()),
    )?)
}
