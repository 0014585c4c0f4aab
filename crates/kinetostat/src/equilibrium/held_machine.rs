//! All equilibria of a machine whose tool is held: limbs between the base and the tool do not feel each other, so that the
//! set of equilibria is the product of the limbs' own sets, which the search of a chain finds.

use crate::chain::found_by::FoundBy;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::equilibrium::all_of_chain::SearchSettings;
use crate::equilibrium::found::{Equilibria, FoundEquilibrium, LimbShapes};
use crate::equilibrium::limb_shapes::{combinations, limb_shapes, state_of};
use crate::equilibrium::search::Coverage;
use crate::error::Result;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::number::larger;
use crate::parallel;
use crate::spatial::{Twist, moved};

/// All equilibria with the tool held, as the product of the limbs' shapes.
pub(crate) fn held_equilibria(
    conditions: &ToolConditions<'_>,
    settings: &SearchSettings,
) -> Result<Equilibria<MechanismEquilibrium>> {
    let posture = conditions.posture;
    let place = moved(
        &posture.target,
        &Twist(conditions.prescribed_displacement()),
    );
    let limbs = limb_shapes(posture, &place, settings)?;
    let found = parallel::map(combinations(&limbs), |combination| {
        let state = state_of(posture, &place, &limbs, &combination);
        let mut solver = posture.solver(state, Unknowns::Displacement);
        let (iterations, norms) = solver.solve(1.0, 0).ok()?;
        let held = conclude(&mut solver, norms.residual(iterations)).ok()?;
        let known = conditions.described(held);
        let shapes = limbs.iter().zip(&combination.shapes);
        let shapes: Vec<_> = shapes.map(|(limb, &i)| &limb.found[i]).collect();
        Some(FoundEquilibrium {
            stable: known.stable,
            may_flutter: known.may_flutter || shapes.iter().any(|shape| shape.may_flutter),
            singular: shapes.iter().any(|shape| is_critical(shape)),
            potential: known.potential,
            // The rarest of its shapes.
            hits: shapes.iter().map(|shape| shape.hits).min().unwrap_or(0),
            equilibrium: MechanismEquilibrium {
                found_by: FoundBy::OtherStart,
                ..known.equilibrium
            },
        })
    });
    let names = posture.mechanism.limbs().iter().map(|limb| &limb.name);
    let own = names
        .zip(&limbs)
        .map(|(name, own)| LimbShapes::of(name, own));
    let (chance, at_most) = limbs.iter().fold((0.0, 0.0), |(a, b), limb| {
        (
            larger(a, limb.chance_of_more),
            larger(b, limb.chance_of_more_at_most),
        )
    });
    let coverage = Coverage {
        starts: limbs.iter().map(|limb| limb.starts).sum(),
        hits: limbs.iter().map(|limb| limb.hits).sum(),
        outside: limbs.iter().map(|limb| limb.outside).sum(),
        fruitless: limbs.iter().map(|limb| limb.fruitless).min().unwrap_or(0),
        chance_of_more: (chance, at_most),
        exhausted: limbs.iter().all(|limb| limb.exhausted),
    };
    Ok(Equilibria {
        limbs: own.collect(),
        incomplete: limbs.iter().any(|limb| limb.incomplete),
        ..Equilibria::of(found.into_iter().flatten().collect(), &coverage, false)
    })
}

/// True if the shape is at its critical load.
fn is_critical(shape: &FoundEquilibrium) -> bool {
    shape.equilibrium.stability.is_critical()
}
