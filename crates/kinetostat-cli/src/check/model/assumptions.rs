//! The assumptions of the method, looked at: are deflections small, is a load near buckling, is a
//! singular posture near.

use kinetostat::{Error, MechanismEquilibrium, Posture};
use kinetostat_analysis::instability::{InstabilityShares, NOTICEABLE};
use kinetostat_analysis::push_stiffness::{PushStiffness, PushStiffnesses};
use kinetostat_analysis::reference_load::{
    CarriedLoad, ForcesFrom, LoadOutcome, SMALL, reference_forces, under_forces,
};
use kinetostat_machining::{
    NEAR_SINGULAR, NearSingular, Warning, WarningCode, folds, natural_length, near_singular,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::displacement_warnings::snaps;
use crate::machine::instability;
use crate::ui::layout::item;
use crate::ui::numbers::{fixed, load_triple, number, short, triple};

/// Findings about the modelling assumptions at home.
#[derive(Serialize, JsonSchema)]
pub(crate) struct AssumptionsFinding {
    /// Mean over the limbs, mm: deflections are compared with it.
    pub(crate) natural_length_mm: f64,
    /// Smallest and largest stiffness of the tool against a force, free to turn, N/mm; directions
    /// that are free or rigid left out. None where some force moves the tool against itself.
    pub(crate) against_force_n_per_mm: Option<[f64; 2]>,
    /// Stiffness against a moment, free to move, N m/rad.
    pub(crate) against_moment_n_m_per_rad: Option<[f64; 2]>,
    /// Shift without load on the tool as a share of the natural length, rotations counted.
    pub(crate) share_without_load: f64,
    /// The reference load, base axes, N: that of `--force`, or the worst of 1 kN along the axes.
    pub(crate) reference_force_n: Option<[f64; 3]>,
    /// Effect on the tool, mm.
    pub(crate) reference_deflection_mm: Option<f64>,
    /// The machine stays in its shape under it; none where there is no equilibrium.
    pub(crate) reference_stable: Option<bool>,
    /// Error of the deflection predicted by the stiffness matrix at rest, percent.
    pub(crate) linear_error_percent: Option<f64>,
    /// Force in the softest direction that moves the tool by 1 % of the natural length, N.
    pub(crate) small_up_to_n: Option<f64>,
    /// Largest share of the way to buckling of any limb under the reference load; 1 is buckling. None
    /// where a load of `--force` has no equilibrium; without load where an assumed one is too much.
    pub(crate) largest_share_to_buckling: Option<f64>,
    /// Largest compression of a link as a share of its Euler load, then.
    pub(crate) largest_share_of_euler_load: Option<f64>,
    /// Share of the way to instability of the machine with its tool free, 1 at instability; at
    /// least 1 or none if unstable.
    pub(crate) largest_share_to_instability_of_free_machine: Option<f64>,
    /// The nearest singular posture, where one is near.
    pub(crate) near_singularity: Option<NearSingular>,
    /// All of it in sentences.
    pub(crate) in_words: Vec<String>,
    /// Findings that deserve a warning.
    #[serde(skip)]
    pub(crate) warnings: Vec<Warning>,
}

/// Looks at the assumptions at home.
pub(crate) fn assumptions(
    posture: &Posture,
    rest: &MechanismEquilibrium,
    force: Option<Vector3<f64>>,
) -> AssumptionsFinding {
    let length = natural_length(posture.mechanism());
    let shift = rest.displacement.linear().norm();
    let turn = rest.displacement.angular().norm();
    let mut found = AssumptionsFinding {
        natural_length_mm: 1e3 * length,
        against_force_n_per_mm: None,
        against_moment_n_m_per_rad: None,
        share_without_load: shift.max(turn * length) / length,
        reference_force_n: None,
        reference_deflection_mm: None,
        reference_stable: None,
        linear_error_percent: None,
        small_up_to_n: None,
        largest_share_to_buckling: None,
        largest_share_of_euler_load: None,
        largest_share_to_instability_of_free_machine: None,
        near_singularity: near_singular(posture),
        in_words: Vec::new(),
        warnings: Vec::new(),
    };
    found.scale(rest);
    found.without_load();
    let loaded = found.under(posture, rest, force);
    found.buckling(posture, rest, loaded.as_ref(), force.is_some());
    found.singular(length);
    found
}

impl AssumptionsFinding {
    fn scale(&mut self, rest: &MechanismEquilibrium) {
        let c = rest.compliance().springs;
        // Motions along free directions are not reported by it.
        if rest.platform.free == 0 {
            let stiffness = PushStiffnesses::of(&c, rest.length);
            let mut against = Vec::new();
            match stiffness.force {
                Some(PushStiffness::Along(range)) => {
                    self.against_force_n_per_mm = Some(range.map(|k| 1e-3 * k));
                }
                Some(PushStiffness::Against) => against.push("force"),
                None => {}
            }
            match stiffness.moment {
                Some(PushStiffness::Along(range)) => self.against_moment_n_m_per_rad = Some(range),
                Some(PushStiffness::Against) => against.push("moment"),
                None => {}
            }
            self.in_words.extend(against.iter().map(|push| {
                format!(
                    "with the loads of the model, a {push} on the tool may move it against that {push}: no stiffness against a {push} is reported"
                )
            }));
        }
        self.small_up_to_n = self
            .against_force_n_per_mm
            .map(|[softest, _]| softest * SMALL * self.natural_length_mm);
    }

    fn without_load(&mut self) {
        let share = self.share_without_load;
        if share < 1e-12 {
            return;
        }
        let percent = number(100.0 * share, 2);
        let text = if share <= SMALL {
            format!(
                "weights, preloads, loads on limbs and deviations move the tool by {percent} % of its natural length: small against the links"
            )
        } else {
            format!(
                "weights, preloads, loads on limbs and deviations move the tool by {percent} % of its natural length: NOT small against the links; the unloaded stiffness is not that of the machine at rest"
            )
        };
        if share > 0.05 {
            let said = format!(
                "without load on the tool it is already off by {percent} % of the natural length ({} mm); check masses, stiffnesses and deviations, and their units",
                short(self.natural_length_mm)
            );
            self.warnings
                .push(Warning::new(WarningCode::LargeDisplacement, said));
        }
        self.in_words.push(text);
    }

    /// The worst of the reference loads, and the machine under it.
    fn under(
        &mut self,
        posture: &Posture,
        rest: &MechanismEquilibrium,
        force: Option<Vector3<f64>>,
    ) -> Option<MechanismEquilibrium> {
        let forces = force.map_or_else(reference_forces, |force| vec![force]);
        let mut worst: Option<(Vector3<f64>, CarriedLoad)> = None;
        let mut free = Vec::new();
        let mut unstable: Option<Vector3<f64>> = None;
        // A requested load is answered by the result of `deflect`, not by first order.
        let from = match force {
            Some(_) => ForcesFrom::User,
            None => ForcesFrom::Assumption,
        };
        for (case, outcome) in under_forces(posture, rest, &forces, from) {
            match outcome {
                LoadOutcome::TooMuch(first_order) => {
                    self.too_much(&case, first_order);
                    return None;
                }
                LoadOutcome::Free => free.push(case),
                LoadOutcome::NoEquilibrium(error) => {
                    self.no_equilibrium(&case, &error, force.is_some());
                }
                LoadOutcome::Carried(load) => {
                    if !load.state.stable() {
                        unstable = unstable.or(Some(case));
                    }
                    if worst.as_ref().is_none_or(|(_, w)| load.moved > w.moved) {
                        self.carried(&case, &load);
                        worst = Some((case, *load));
                    }
                }
            }
        }
        self.free_directions(&free, force.is_some());
        self.not_stable(unstable, free.is_empty());
        let (case, load) = worst?;
        if force.is_some() {
            self.large_displacement(posture, rest, &load.state);
        }
        self.small(load.moved / (1e-3 * self.natural_length_mm), &case);
        Some(load.state)
    }

    fn carried(&mut self, case: &Vector3<f64>, load: &CarriedLoad) {
        self.reference_force_n = Some((*case).into());
        self.reference_deflection_mm = Some(1e3 * load.moved);
        self.reference_stable = Some(load.state.stable());
        self.linear_error_percent = Some(100.0 * load.linear_error);
    }

    fn no_equilibrium(&mut self, case: &Vector3<f64>, error: &Error, force_given: bool) {
        let said = format!(
            "a load of {} N has no equilibrium that could be found: {error}",
            load_triple((*case).into())
        );
        if force_given {
            self.reference_force_n = Some((*case).into());
            let none = Warning::new(WarningCode::NoEquilibrium, said.clone());
            self.warnings.insert(0, none);
            self.in_words.insert(0, said);
        } else {
            self.in_words.push(said);
        }
    }

    fn free_directions(&mut self, free: &[Vector3<f64>], force_given: bool) {
        if free.is_empty() {
            return;
        }
        let list: Vec<String> = free.iter().map(|f| triple((*f).into(), short)).collect();
        let said = format!(
            "nothing carries a load of {} N: it pushes in a free direction",
            list.join(" or ")
        );
        if force_given {
            self.warnings
                .push(Warning::new(WarningCode::FreeDirection, said.clone()));
        }
        self.in_words.push(said);
    }

    fn not_stable(&mut self, unstable: Option<Vector3<f64>>, all_carried: bool) {
        let Some(case) = unstable else { return };
        let said = format!(
            "under a load of {} N on the tool the machine does NOT stay in its shape: NOT STABLE; see `kinetostat deflect`",
            load_triple(case.into())
        );
        // A free motion is not meant to carry the example load.
        if all_carried {
            let first = Warning::new(WarningCode::NotStable, said.clone());
            self.warnings.insert(0, first);
        }
        self.in_words.insert(0, said);
    }

    fn large_displacement(
        &mut self,
        posture: &Posture,
        rest: &MechanismEquilibrium,
        loaded: &MechanismEquilibrium,
    ) {
        let far = loaded.displacement.linear().norm();
        self.warnings.extend(folds(far, posture.mechanism().size()));
        if let Ok(Some(limit)) = posture.snaps_before(rest, loaded) {
            let snaps = snaps(&limit);
            self.in_words.push(snaps.message.clone());
            self.warnings.push(snaps);
        }
    }

    fn too_much(&mut self, case: &Vector3<f64>, reported: f64) {
        let share = 1e3 * reported / self.natural_length_mm;
        self.reference_force_n = Some((*case).into());
        self.in_words.push(format!(
            "a load of {} N is far too much for this machine: to first order the tool would move by {} % of the natural length; along it deflections are small (1 %) up to about {} N",
            load_triple((*case).into()),
            number(100.0 * share, 2),
            number(case.norm() * SMALL / share, 2),
        ));
    }

    fn small(&mut self, share: f64, case: &Vector3<f64>) {
        let limit = self.small_up_to_n.map_or_else(String::new, |n| {
            format!(
                "; that reaches 1 % at about {} N in the softest direction",
                number(n, 2)
            )
        });
        // A smaller error is rounding.
        let error = self.linear_error_percent.filter(|e| *e > 1e-9);
        let error = error.unwrap_or(0.0);
        let result = if share <= SMALL {
            "small against the links"
        } else {
            "NOT small against the links: ask `kinetostat deflect`, which solves the bent machine, and do not multiply with the stiffness matrix"
        };
        self.in_words.push(format!(
            "a load of {} N moves the tool by {} mm, {} % of the natural length: {result}; the stiffness matrix alone would be {} % off{limit}",
            load_triple((*case).into()),
            fixed(self.reference_deflection_mm.unwrap_or(0.0), 4),
            number(100.0 * share, 2),
            number(error, 2),
        ));
    }

    /// Share of the way to buckling, under the load if there is one and it is carried; without it
    /// if there is none or that is worse.
    fn buckling(
        &mut self,
        posture: &Posture,
        rest: &MechanismEquilibrium,
        loaded: Option<&MechanismEquilibrium>,
        force_given: bool,
    ) {
        let at_rest = InstabilityShares::of(posture, rest);
        let under = loaded.map(|e| InstabilityShares::of(posture, e));
        let assessed = under.as_ref().or((!force_given).then_some(&at_rest));
        if let Some(assessed) = assessed {
            self.largest_share_to_buckling = assessed.limb.map(|l| l.share);
            self.largest_share_of_euler_load = assessed.link.map(|l| l.share);
            self.largest_share_to_instability_of_free_machine = assessed.free;
        }
        let worse = at_rest.largest() > NOTICEABLE
            && under
                .as_ref()
                .is_none_or(|u| at_rest.largest() > u.largest());
        let states = [
            (Some(&at_rest).filter(|_| under.is_none() || worse), false),
            (under.as_ref(), true),
        ];
        for (state, under_load) in states {
            let Some(state) = state else { continue };
            let said = instability::description(state, under_load);
            if state.is_near_buckling() {
                self.warnings
                    .push(Warning::new(WarningCode::NearBuckling, said.clone()));
            } else if state.state().may_flutter() {
                self.warnings
                    .push(Warning::new(WarningCode::NoPotential, said.clone()));
            }
            self.in_words.push(said);
        }
    }

    fn singular(&mut self, length: f64) {
        match &self.near_singularity {
            Some(near) => {
                self.in_words.push(near.in_words.clone());
                let said = format!("at home: {}", near.in_words);
                self.warnings
                    .push(Warning::new(WarningCode::NearSingular, said));
            }
            None => self.in_words.push(format!(
                "no singular posture within {} mm, or {} deg of rotation, of home",
                number(1e3 * NEAR_SINGULAR * length, 2),
                number(NEAR_SINGULAR.to_degrees(), 2)
            )),
        }
    }
}

/// The section about scale and assumptions.
pub(crate) fn assumptions_text(a: &AssumptionsFinding, force_given: bool) -> String {
    let mut out = String::from("\nScale, and whether the method holds\n");
    let span = |[low, high]: [f64; 2]| {
        if high <= low * 1.001 {
            number(low, 4)
        } else {
            format!("{} to {}", number(low, 4), number(high, 4))
        }
    };
    let mut text = format!(
        "natural length {} mm",
        short((10.0 * a.natural_length_mm).round() / 10.0)
    );
    if let Some(k) = a.against_force_n_per_mm {
        text.push_str(&format!(
            "; against a force the tool is stiff with {} N/mm",
            span(k)
        ));
    }
    if let Some(k) = a.against_moment_n_m_per_rad {
        let verb = match a.against_force_n_per_mm {
            Some(_) => ", against a moment with",
            None => "; against a moment the tool is stiff with",
        };
        text.push_str(&format!("{verb} {} N m/rad", span(k)));
    }
    out.push_str(&item(&text));
    for line in &a.in_words {
        out.push_str(&item(line));
    }
    if !force_given {
        out.push_str(&item(
            "the load is an example, the worst of 1 kN along and against x, y and z; give yours with --force FX FY FZ",
        ));
    }
    out
}
