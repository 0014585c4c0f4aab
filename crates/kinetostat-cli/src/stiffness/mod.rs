//! `kinetostat stiffness`: the 6 x 6 matrix of the tool at a place, with units, axes and reference point.
//!
//! It takes a model, a place and perhaps a load, and gives stiffness and compliance, their principal directions,
//! and the share of each limb.

mod answer;
pub(crate) mod arguments;
mod text;

use kinetostat::Direction;

use crate::files::input_files::InputFiles;
use crate::place::query::place_query;
use crate::stiffness::answer::{Tangent, answer, with_causes, with_own_loads};
use crate::stiffness::arguments::StiffnessArgs;
use crate::stiffness::text::answer_text;
use crate::ui::failure::Answer;
use crate::ui::json;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<answer::Stiffness>(
    "stiffness at one place",
)];

pub(crate) fn run(args: &StiffnessArgs) -> Answer<()> {
    let query = place_query(
        &InputFiles::default(),
        &args.model,
        &args.place,
        args.tool_length_mm,
        args.force.as_deref(),
        args.moment.as_deref(),
    )?;
    let posture = query.posture()?;
    let loaded = args.force.is_some() || args.moment.is_some();
    let answer = if loaded {
        let e = posture.deflected_by(&query.wrench)?;
        let limbs = e.limbs.iter().map(|l| &l.stiffness);
        let limbs = limbs.zip(e.limb_stiffnesses(&query.mechanism)).collect();
        let participation = |d: &Direction| e.participation(&query.mechanism, &d.twist);
        let tangent = Tangent {
            loaded: true,
            against_force: e.stiffness_against_force(),
            cartesian: &e.stiffness,
            compliance: e.compliance(),
            directions: with_causes(&e.directions, participation),
            limbs,
        };
        answer(&query, &posture, tangent)
    } else {
        let k = posture.stiffness()?;
        let limbs = k.limbs.iter().zip(k.limb_stiffnesses(&posture)).collect();
        let tangent = Tangent {
            loaded: false,
            against_force: k.stiffness_against_force(),
            cartesian: &k.cartesian,
            compliance: k.compliance(),
            directions: with_causes(&k.directions, |d| k.participation(&posture, &d.twist)),
            limbs,
        };
        let mut answer = answer(&query, &posture, tangent);
        with_own_loads(&mut answer, &query, &posture);
        answer
    };
    let text = answer_text(&query, &answer);
    json::print_answer(&text, &answer, args.json)
}
