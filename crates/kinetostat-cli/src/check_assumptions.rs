//! The assumptions of the method, looked at: are deflections small, is a load near buckling, is a
//! singular posture near.

use kinetostat::{Error, MechanismEquilibrium, Posture, Wrench};
use kinetostat_machining::number as formatter;
use kinetostat_machining::{
    NEAR_SINGULAR, NearSingular, Warning, WarningCode, natural_length, near_singular,
};
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use crate::machine::short;
use crate::screen::{fixed, item, number, triple};

/// Size of the load that is assumed if none is given, N.
const REFERENCE_N: f64 = 1000.0;

/// A deflection by this share of the natural length is small: the unloaded stiffness is then off
/// by about as much.
const SMALL: f64 = 0.01;

/// From here on the load is not even tried.
const TOO_MUCH: f64 = 0.2;

/// From this share of the way to buckling on the stiffness changes noticeably.
pub(crate) const NOTICEABLE: f64 = 0.1;

/// What was found about the assumptions, at home.
#[derive(Serialize)]
pub(crate) struct AssumptionsFinding {
    /// Mean over the limbs, mm: deflections are compared with it.
    pub(crate) natural_length_mm: f64,
    /// Smallest and largest stiffness of the tool against a force, free to turn, N/mm; directions
    /// that are free or rigid left out.
    pub(crate) against_force_n_per_mm: Option<[f64; 2]>,
    /// The same against a moment, free to move, N m/rad.
    pub(crate) against_moment_n_m_per_rad: Option<[f64; 2]>,
    /// Without load on the tool: its shift as a share of the natural length, rotations counted.
    pub(crate) share_without_load: f64,
    /// The reference load, base axes, N: that of `--force`, or the worst of 1 kN along the axes.
    pub(crate) reference_force_n: Option<[f64; 3]>,
    /// What it does to the tool, mm.
    pub(crate) reference_deflection_mm: Option<f64>,
    /// By how much the stiffness matrix at rest would tell a wrong deflection, percent.
    pub(crate) linear_error_percent: Option<f64>,
    /// Force in the softest direction that moves the tool by 1 % of the natural length, N.
    pub(crate) small_up_to_n: Option<f64>,
    /// Largest share of the way to buckling of any limb, with and without the load; 1 is buckling.
    pub(crate) largest_share_to_buckling: Option<f64>,
    /// Largest compression of a link as a share of its Euler load.
    pub(crate) largest_share_of_euler_load: Option<f64>,
    /// How near the loads bring the machine with its tool free to instability, 1 is there.
    pub(crate) largest_share_to_instability_of_free_machine: Option<f64>,
    /// The nearest singular posture, where one is near.
    pub(crate) near_singularity: Option<NearSingular>,
    /// All of it in sentences.
    pub(crate) in_words: Vec<String>,
    /// Those that deserve a warning.
    #[serde(skip)]
    pub(crate) warnings: Vec<Warning>,
}

/// Looks at the assumptions at home.
pub(crate) fn assumptions(
    posture: &Posture<'_>,
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
    found.buckling(posture, rest, loaded.as_ref());
    found.singular(length);
    found
}

/// Compliances below this share of the largest, rotations at the natural length, are rounding.
const NO_MOTION: f64 = 1e-12;

/// Stiffnesses behind a block of a compliance, the softest and the stiffest, N/m or N m/rad.
fn range(block: &Matrix3<f64>) -> Option<[f64; 2]> {
    let values = block.symmetric_eigenvalues();
    let most = values.max();
    let least = values.iter().copied().filter(|x| *x > 1e-9 * most);
    let least = least.fold(f64::INFINITY, f64::min);
    (most > 0.0 && least.is_finite()).then(|| [1.0 / most, 1.0 / least])
}

impl AssumptionsFinding {
    fn scale(&mut self, rest: &MechanismEquilibrium) {
        let c = rest.compliance().springs;
        // Motions along free directions are not told by it.
        if rest.platform.free == 0 {
            let force: Matrix3<f64> = c.fixed_view::<3, 3>(0, 0).into_owned();
            let moment: Matrix3<f64> = c.fixed_view::<3, 3>(3, 3).into_owned();
            // One block beside which the other is rounding has no motion at all.
            let (moves, turns) = (force.amax(), moment.amax() * rest.length.powi(2));
            let nothing = NO_MOTION * moves.max(turns);
            if moves > nothing {
                self.against_force_n_per_mm = range(&force).map(|r| r.map(|k| 1e-3 * k));
            }
            if turns > nothing {
                self.against_moment_n_m_per_rad = range(&moment);
            }
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
                "weights, preloads, loads on limbs and deviations move the tool by {percent} % of its natural length: NOT small against the links; the unloaded stiffness is not that of the machine as it stands"
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
        posture: &Posture<'_>,
        rest: &MechanismEquilibrium,
        force: Option<Vector3<f64>>,
    ) -> Option<MechanismEquilibrium> {
        let cases = match force {
            Some(force) => vec![force],
            None => (0..6)
                .map(|k| {
                    let sign = if k % 2 == 0 {
                        REFERENCE_N
                    } else {
                        -REFERENCE_N
                    };
                    Vector3::ith(k / 2, sign)
                })
                .collect(),
        };
        let compliance = rest.compliance();
        let linear = |force: &Vector3<f64>| -> Vector3<f64> {
            compliance.springs.fixed_view::<3, 3>(0, 0) * force
        };
        let length = 1e-3 * self.natural_length_mm;
        let mut worst: Option<(f64, Vector3<f64>, MechanismEquilibrium)> = None;
        let mut free = Vec::new();
        let mut jumps: Option<Vector3<f64>> = None;
        for case in cases {
            let told = linear(&case);
            if told.norm() > TOO_MUCH * length {
                self.too_much(&case, told.norm());
                return None;
            }
            let loaded = match posture.deflected_by(&Wrench::new(case, Vector3::zeros())) {
                Ok(loaded) => loaded,
                Err(Error::FreeDirection { .. }) => {
                    free.push(case);
                    continue;
                }
                Err(error) => {
                    self.in_words.push(format!(
                        "a load of {} N has no equilibrium that could be found: {error}",
                        triple(case.into(), short)
                    ));
                    continue;
                }
            };
            if !loaded.stable() {
                jumps = jumps.or(Some(case));
            }
            let moved = loaded.displacement.linear() - rest.displacement.linear();
            if worst
                .as_ref()
                .is_none_or(|(most, _, _)| moved.norm() > *most)
            {
                let error = (moved - told).norm() / moved.norm().max(1e-15);
                self.reference_force_n = Some(case.into());
                self.reference_deflection_mm = Some(1e3 * moved.norm());
                self.linear_error_percent = Some(100.0 * error);
                worst = Some((moved.norm(), case, loaded));
            }
        }
        if !free.is_empty() {
            let list: Vec<String> = free.iter().map(|f| triple((*f).into(), short)).collect();
            self.in_words.push(format!(
                "nothing carries a load of {} N: it pushes in a free direction",
                list.join(" or ")
            ));
        }
        if let Some(case) = jumps {
            let said = format!(
                "under a load of {} N on the tool the machine does not stay in its shape; see `kinetostat deflect`",
                triple(case.into(), short)
            );
            // What moves freely is not meant to carry the example load.
            match free.is_empty() {
                true => self
                    .warnings
                    .push(Warning::new(WarningCode::NotStable, said)),
                false => self.in_words.push(said),
            }
        }
        let (moved, case, loaded) = worst?;
        self.small(moved / length, &case);
        Some(loaded)
    }

    fn too_much(&mut self, case: &Vector3<f64>, told: f64) {
        let share = 1e3 * told / self.natural_length_mm;
        self.reference_force_n = Some((*case).into());
        self.in_words.push(format!(
            "a load of {} N is far too much for this machine: to first order the tool would move by {} % of the natural length; along it deflections are small (1 %) up to about {} N",
            triple((*case).into(), short),
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
        let error = self.linear_error_percent.unwrap_or(0.0);
        let judged = if share <= SMALL {
            "small against the links"
        } else {
            "NOT small against the links: ask `kinetostat deflect`, which solves the bent machine, and do not multiply with the stiffness matrix"
        };
        self.in_words.push(format!(
            "a load of {} N moves the tool by {} mm, {} % of the natural length: {judged}; the stiffness matrix alone would be {} % off{limit}",
            triple((*case).into(), short),
            fixed(self.reference_deflection_mm.unwrap_or(0.0), 4),
            number(100.0 * share, 2),
            number(error, 2),
        ));
    }

    fn buckling(
        &mut self,
        posture: &Posture<'_>,
        rest: &MechanismEquilibrium,
        loaded: Option<&MechanismEquilibrium>,
    ) {
        let states = || std::iter::once(rest).chain(loaded);
        let limbs = || states().flat_map(|e| &e.limbs);
        let share_to_buckling = limbs()
            .filter_map(|l| {
                Some((
                    l.stability.share_to_buckling.filter(|m| m.is_finite())?,
                    &l.name,
                ))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let link = limbs()
            .flat_map(|l| {
                l.link_loads
                    .iter()
                    .map(move |k| (k.share, &l.name, &k.link))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        self.largest_share_to_buckling = share_to_buckling.map(|(m, _)| m);
        self.largest_share_of_euler_load = link.map(|(s, _, _)| s);
        let mut text = String::new();
        let mut most = 0.0_f64;
        if let Some((mu, limb)) = share_to_buckling {
            most = most.max(mu);
            text = if mu > 1e-9 {
                format!(
                    "the load brings limb '{limb}' {} of the way to buckling",
                    formatter::share(mu)
                )
            } else {
                "no load brings a limb towards buckling".to_owned()
            };
        }
        if let Some((share, limb, link)) = link.filter(|l| l.0 > 0.0) {
            most = most.max(share);
            let joint = if text.is_empty() { "" } else { "; " };
            text.push_str(&format!(
                "{joint}the link nearest to its Euler load is '{link}' of '{limb}', {} of it",
                formatter::share(share)
            ));
        }
        let free = states().filter_map(|e| crate::free_machine::share(posture, e));
        let free = free.max_by(f64::total_cmp);
        self.largest_share_to_instability_of_free_machine = free;
        if let Some(share) = free.filter(|s| *s > NOTICEABLE) {
            let joint = if text.is_empty() { "" } else { "; " };
            let nearest = if share > most {
                ", which is nearest to instability,"
            } else {
                ""
            };
            text.push_str(&format!(
                "{joint}the machine with its tool free{nearest} goes {} % of the way",
                number(100.0 * share, 3)
            ));
            most = most.max(share);
        }
        if text.is_empty() {
            text = "no limb has anything that could buckle".to_owned();
        }
        let judged = if most > 0.5 {
            ": NEAR BUCKLING"
        } else if most > NOTICEABLE {
            ": stiffness changes noticeably with the load"
        } else {
            ": far from buckling"
        };
        if most > 0.5 {
            let said = format!("{text}{judged}");
            self.warnings
                .push(Warning::new(WarningCode::NearBuckling, said));
        }
        if most > 0.0 {
            text.push_str(judged);
        }
        self.in_words.push(text);
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
pub(crate) fn in_words(a: &AssumptionsFinding, force_given: bool) -> String {
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
