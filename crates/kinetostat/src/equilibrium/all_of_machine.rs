//! All equilibria of a machine as it is commanded, as far as they can be found.

use crate::chain::problem::EndCondition;
use crate::chain::residual::FoundBy;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::equilibrium::all_of_chain::{SearchSettings, has_passive_slide};
use crate::equilibrium::found::{Equilibria, FoundEquilibrium, LimbShapes};
use crate::equilibrium::limb_shapes::{
    are_searched_one_by_one, combinations, limb_shapes, state_of,
};
use crate::equilibrium::machine_search::{Known, MachineSearch};
use crate::equilibrium::search::{Coverage, Entry, Limits, search};
use crate::error::Result;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::posture::Posture;
use crate::number::larger;
use crate::parallel;
use crate::spatial::{Twist, moved};

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SpreadSettings {
    /// Starts at most. Default 1000.
    pub starts: usize,
    /// The search ends after this many in a row that found nothing new. Default 100.
    pub fruitless: usize,
}

crate::settings::setters!(SpreadSettings {
    with_starts: starts: usize,
    with_fruitless: fruitless: usize,
});

impl Default for SpreadSettings {
    fn default() -> Self {
        Self {
            starts: 1000,
            fruitless: 100,
        }
    }
}

/// Starts of one limb per start of a whole machine: they cost less.
const LIMB_STARTS: usize = 4;

impl SpreadSettings {
    /// Settings for limbs that are searched one by one.
    fn of_limbs(self) -> SearchSettings {
        SearchSettings::default()
            .with_starts(LIMB_STARTS * self.starts)
            .with_fruitless(LIMB_STARTS * self.fruitless)
    }
}

impl Posture {
    /// Equilibria of the machine as it is commanded: the tool held at `end.pose` in the directions
    /// whose pose is prescribed, under the dead wrench `end.wrench` in the others.
    ///
    /// With the tool held in all directions and short limbs from the base to the tool, limbs do not feel each other: every
    /// combination of their own shapes ([`Equilibria::limbs`]) is an equilibrium, found as
    /// [`equilibria`](crate::equilibria) finds those of a chain. Otherwise
    /// the tool is held at places spread evenly and let go down the potential, and Newton is started
    /// with joints turned; from the commanded place and from every equilibrium found the tool is driven
    /// along each of its free motions, and every place where that takes no force is looked at; from
    /// unstable ones it is pushed along the motions in which they go away. Those with a slide turned inside out are not
    /// listed, nor unstable ones farther than three sizes of the machine from the nominal target or with springs beyond
    /// [`Bounds::of`](crate::equilibrium::Bounds::of) their limb. Energies leave out the work of the dead wrench up to the
    /// nominal target.
    ///
    /// # Errors
    /// Not-a-numbers in the condition. That nothing was found is a result.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let free = EndCondition::wrench(Wrench::zero());
    /// let settings = equilibrium::SpreadSettings::default().with_starts(4);
    /// let all = arm.posture(&home)?.equilibria(&free, &settings)?;
    /// assert_eq!(all.found.len(), 1);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn equilibria(
        &self,
        end: &EndCondition,
        settings: &SpreadSettings,
    ) -> Result<Equilibria<MechanismEquilibrium>> {
        let conditions = ToolConditions::at_displacement(self, end)?;
        if conditions.free.ncols() == 0 && are_searched_one_by_one(self) {
            return held_equilibria(
                &conditions,
                &settings.of_limbs().with_solver(*self.settings()),
            );
        }
        let mut system = MachineSearch::new(conditions);
        let limits = Limits {
            fruitless: settings.fruitless,
            starts: settings.starts,
            most: usize::MAX,
        };
        let (known, coverage) = search(&mut system, &limits);
        let found = known.into_iter().map(of_entry);
        let mechanism = &self.mechanism;
        let mut limbs = mechanism.limbs().iter();
        // Weights and loads may lower the energy without end along a passive slide.
        let has_minimum = end.wrench.0.amax() == 0.0
            && limbs.all(|limb| !has_passive_slide(&limb.actual))
            && self.others.is_empty();
        Ok(Equilibria::of(found.collect(), &coverage, has_minimum))
    }
}

fn of_entry(entry: Entry<Known>) -> FoundEquilibrium<MechanismEquilibrium> {
    let k = entry.known;
    FoundEquilibrium {
        stable: k.stable,
        may_flutter: k.may_flutter,
        singular: k.singular,
        potential: k.potential,
        hits: entry.hits,
        equilibrium: MechanismEquilibrium {
            found_by: FoundBy::OtherStart,
            ..k.equilibrium
        },
    }
}

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
