//! Value of a placement, at some places of the program or at all of them.

use kinetostat::Pose;
use kinetostat::number::{larger, smaller};
use kinetostat_machining::{MovableProgram, Placement, Reach, RunError};
use nalgebra::{Point3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::placing::space::{Place, Space};
use crate::placing::value::{Objective, Refusal, Value, Why};

/// Objective and constraints of a search.
#[derive(Clone, Debug, Default)]
pub struct Question {
    /// Figure to be minimised.
    pub objective: Objective,
    /// Boxes that neither path nor part may enter.
    pub obstacles: Vec<Obstacle>,
    /// A box around the part that is kept clear of obstacles, too; only the path is without it.
    pub part: Option<PartBox>,
}

/// Places that tell how far a placement is from being reached.
const PROBES: usize = 12;

/// Number of lost places after which all are taken as lost, if none is reached: checking each of them takes longest.
const ENOUGH: f64 = 4.0;

/// Answers what placements are worth.
pub(crate) struct Evaluator<'e> {
    pub(crate) program: &'e MovableProgram<'e, 'e>,
    pub(crate) space: &'e Space,
    pub(crate) question: &'e Question,
    /// Tool position at home, m, and size of the machine: a program out of reach is led back there.
    pub(crate) home: Vector3<f64>,
    pub(crate) size: f64,
}

/// A placement at all places of the program.
pub(crate) struct OnAll {
    pub(crate) value: Value,
    /// Place with the largest figure, or where it is refused.
    pub(crate) worst: Option<usize>,
    /// Places that a search must look at so that it sees the same, worst first.
    pub(crate) telling: Vec<usize>,
}

impl Evaluator<'_> {
    /// Value of a placement at some places.
    pub(crate) fn at(&self, place: &Place, places: &[usize]) -> Value {
        let lies = self.space.placement(place);
        // Out of reach is found sooner without a load.
        let lost = self.obstacle(&lies).or_else(|| self.lost(lies, None));
        match lost {
            Some(refusal) => Value::Refused(refusal),
            None => self.solved(lies, places).value,
        }
    }

    /// Value of a placement at all places, posture by posture.
    pub(crate) fn on_all(&self, lies: Placement) -> OnAll {
        if let Some(refusal) = self.obstacle(&lies) {
            return refused(refusal, Vec::new());
        }
        let all: Vec<usize> = (0..self.program.len()).collect();
        self.solved(lies, &all)
    }

    fn solved(&self, lies: Placement, places: &[usize]) -> OnAll {
        match self.figures(lies, places) {
            Ok(found) => found,
            Err((at, error)) => {
                let telling = vec![places[at]];
                refused(self.refusal(lies, places[at], &error), telling)
            }
        }
    }

    fn figures(&self, lies: Placement, places: &[usize]) -> Result<OnAll, (usize, RunError)> {
        let objective = self.question.objective;
        let cuts = places.iter().any(|&i| self.program.at_feed(i));
        let counts = |i: usize| !objective.at_feed_only() || !cuts || self.program.at_feed(i);
        let figures: Vec<Option<f64>> = if objective == Objective::Correction {
            let found = self.program.corrections_mm(lies, places)?;
            found.into_iter().map(Some).collect()
        } else {
            let points = self.program.points(lies, places)?;
            if let Some(at) = points.iter().position(|point| !point.stable) {
                let line = Some(self.program.line(places[at]));
                let unstable = points.iter().filter(|point| !point.stable).count();
                let refusal = Refusal {
                    why: Why::Unstable,
                    line,
                    amount: unstable as f64 / points.len() as f64,
                    message: "the machine would jump to another shape under this load".to_owned(),
                };
                return Ok(refused(refusal, vec![places[at]]));
            }
            let all = places.len() == self.program.len();
            if let Some(found) = self.changes(lies, places, &points, all) {
                return Ok(found);
            }
            points.iter().map(|point| objective.figure(point)).collect()
        };
        let counted = places.iter().zip(&figures).filter(|(i, _)| counts(**i));
        let mut known: Vec<(f64, usize)> = counted
            .filter_map(|(i, figure)| Some(((*figure)?, *i)))
            .collect();
        if known.iter().any(|(figure, _)| !figure.is_finite()) || known.is_empty() {
            let message = match objective {
                Objective::Drive => {
                    "the model states no rating of a drive (rated_force_n or rated_torque_n_m of its actuators): add them, or take another --objective"
                }
                Objective::Buckling => "the machine has no inner freedom that could buckle",
                _ => "no figure was found",
            };
            let refusal = Refusal {
                why: Why::NoFigure,
                line: None,
                amount: 1.0,
                message: message.to_owned(),
            };
            return Ok(refused(refusal, Vec::new()));
        }
        // The first place is kept among equal figures.
        known.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        Ok(OnAll {
            value: Value::Figure(known[0].0),
            worst: Some(known[0].1),
            telling: apart(&known, self.program.len()),
        })
    }

    /// The posture of an arm changes between two places that are cut.
    fn changes(
        &self,
        lies: Placement,
        places: &[usize],
        points: &[kinetostat_machining::PointResult],
        all: bool,
    ) -> Option<OnAll> {
        let numbered = places.iter().zip(points).filter_map(|(i, point)| {
            let configuration = point.configuration.filter(|_| self.program.at_feed(*i))?;
            Some((*i, configuration.number))
        });
        let numbered: Vec<(usize, u8)> = numbered.collect();
        let (first, number) = *numbered.first()?;
        let others: Vec<usize> = numbered
            .iter()
            .filter(|(_, other)| *other != number)
            .map(|(i, _)| *i)
            .collect();
        let refusal = |line: usize, share: f64| Refusal {
            why: Why::PostureChanges,
            line: Some(line),
            amount: share,
            message: "the arm would have to change its posture while it cuts".to_owned(),
        };
        if let Some(other) = others.first() {
            let share = others.len() as f64 / numbered.len() as f64;
            let refusal = refusal(self.program.line(*other), smaller(share, 1.0 - share));
            return Some(refused(refusal, vec![first, *other]));
        }
        if !all {
            return None;
        }
        // Neighbours tell it only where all places are looked at.
        let (_, line) = self.program.posture_changes(lies, points)?;
        Some(refused(refusal(line, 0.0), Vec::new()))
    }

    /// Reason for which a place has no answer, and distance of the placement from being taken.
    fn refusal(&self, lies: Placement, place: usize, error: &RunError) -> Refusal {
        self.lost(lies, Some(place)).unwrap_or_else(|| Refusal {
            why: Why::NoEquilibrium,
            line: Some(self.program.line(place)),
            amount: 0.0,
            message: match error {
                RunError::Point { message, .. } => message.clone(),
                other => other.to_string(),
            },
        })
    }

    /// Refusal of a placement at which some places, and one more, are not reached, with its distance from being
    /// taken.
    fn lost(&self, lies: Placement, place: Option<usize>) -> Option<Refusal> {
        let count = self.program.len();
        // Far from each other one after the other.
        let spread = (0..PROBES).map(|k| (5 * k % PROBES) * count / PROBES);
        let probes = place.into_iter().chain(spread);
        let (mut lost, mut all, mut far) = (0.0, 0.0, 0.0);
        let mut first: Option<Refusal> = None;
        for probe in probes {
            if lost >= ENOUGH && lost == all {
                break;
            }
            all += 1.0;
            let pose = self.program.tool_pose(lies, probe);
            let away = (pose.translation.vector - self.home).norm() / self.size;
            far = larger(far, away);
            if let Reach::Refused { by_limits, message } = self.program.reach(lies, probe) {
                lost += 1.0;
                let why = match by_limits {
                    true => Why::OutsideLimits,
                    false => Why::Unreachable,
                };
                first.get_or_insert(Refusal {
                    why,
                    line: Some(self.program.line(probe)),
                    amount: 0.0,
                    message,
                });
            }
        }
        let mut refusal = first?;
        // All of it out of reach is led back by the distance alone.
        refusal.amount = lost / all + far;
        Some(refusal)
    }

    /// Path or part enters an obstacle.
    fn obstacle(&self, lies: &Placement) -> Option<Refusal> {
        let obstacles = &self.question.obstacles;
        if obstacles.is_empty() {
            return None;
        }
        let mut pose_mm = lies.base_from_part;
        pose_mm.translation.vector *= 1e3;
        let tips: Vec<Vector3<f64>> = (0..self.program.len())
            .map(|i| self.program.tool_pose(*lies, i).translation.vector * 1e3)
            .collect();
        let mut worst: Option<Refusal> = None;
        for obstacle in obstacles {
            let mut inside = 0.0;
            let mut first = None;
            for (i, tip) in tips.iter().enumerate() {
                let from = &tips[i.saturating_sub(1)];
                let share = obstacle.share_inside(from, tip);
                if share > 0.0 {
                    inside += share;
                    first.get_or_insert(i);
                }
            }
            let depth = (self.question.part).map_or(0.0, |part| obstacle.depth_of(&part, &pose_mm));
            let amount = 10.0 + inside / tips.len() as f64 + 1e-3 * depth / self.size;
            if (inside > 0.0 || depth > 0.0) && worst.as_ref().is_none_or(|w| amount > w.amount) {
                let what = match inside > 0.0 {
                    true => "the path of the tool",
                    false => "the part",
                };
                worst = Some(Refusal {
                    why: Why::Obstacle,
                    line: first.map(|i| self.program.line(i)),
                    amount,
                    message: format!("{what} enters the obstacle '{}'", obstacle.name),
                });
            }
        }
        worst
    }
}

fn refused(refusal: Refusal, telling: Vec<usize>) -> OnAll {
    OnAll {
        value: Value::Refused(refusal),
        worst: telling.last().copied(),
        telling,
    }
}

/// Maximum number of places that one evaluation adds to those of the search.
const MOST_TELLING: usize = 6;

/// The worst places, no two of which are neighbours.
fn apart(known: &[(f64, usize)], count: usize) -> Vec<usize> {
    let near = count / 100;
    let mut telling: Vec<usize> = Vec::new();
    for (_, i) in known {
        if telling.len() == MOST_TELLING {
            break;
        }
        if telling.iter().all(|t| t.abs_diff(*i) > near) {
            telling.push(*i);
        }
    }
    telling
}

/// A box with its edges along the axes of the base, mm.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Name in messages.
    pub name: String,
    /// Smallest coordinates, base axes, mm.
    pub from_mm: [f64; 3],
    /// Largest coordinates.
    pub to_mm: [f64; 3],
}

/// A box around the part, with its edges along the axes of the program, mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartBox {
    /// Smallest coordinates of the program, mm.
    pub from_mm: [f64; 3],
    /// Largest coordinates.
    pub to_mm: [f64; 3],
}

impl Obstacle {
    /// Share of the straight way from `a` to `b` (base axes, mm) that lies inside.
    pub(crate) fn share_inside(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        let way = b - a;
        for k in 0..3 {
            let [low, high] = [self.from_mm[k] - a[k], self.to_mm[k] - a[k]];
            if way[k].abs() < 1e-12 {
                if low > 0.0 || high < 0.0 {
                    return 0.0;
                }
                continue;
            }
            let (first, last) = match way[k] > 0.0 {
                true => (low / way[k], high / way[k]),
                false => (high / way[k], low / way[k]),
            };
            enters = kinetostat::number::larger(enters, first);
            leaves = kinetostat::number::smaller(leaves, last);
        }
        match way.norm() < 1e-12 {
            // A place that is inside is wholly inside.
            true => 1.0,
            false if leaves > enters => leaves - enters,
            false => 0.0,
        }
    }

    /// Depth of a box on the part inside this one, mm; 0 if the two do not meet. Two boxes are apart exactly if one of fifteen
    /// directions shows a gap: the edges of both and their cross products.
    pub(crate) fn depth_of(&self, part: &PartBox, base_from_part_mm: &Pose) -> f64 {
        let half =
            |from: &[f64; 3], to: &[f64; 3]| (Vector3::from(*to) - Vector3::from(*from)) / 2.0;
        let middle =
            |from: &[f64; 3], to: &[f64; 3]| (Vector3::from(*to) + Vector3::from(*from)) / 2.0;
        let own = half(&self.from_mm, &self.to_mm);
        let other = half(&part.from_mm, &part.to_mm);
        let there = base_from_part_mm * Point3::from(middle(&part.from_mm, &part.to_mm));
        let apart = there.coords - middle(&self.from_mm, &self.to_mm);
        let turned = base_from_part_mm.rotation.to_rotation_matrix();
        let edges = |k: usize| turned.matrix().column(k).into_owned();
        let unit = |k: usize| Vector3::ith(k, 1.0);
        let crosses = (0..9).map(|k| unit(k / 3).cross(&edges(k % 3)));
        let directions = (0..3).map(unit).chain((0..3).map(edges)).chain(crosses);
        let mut depth = f64::INFINITY;
        for direction in directions {
            let length = direction.norm();
            if length < 1e-9 {
                continue;
            }
            let along = direction / length;
            let reach: f64 = (0..3)
                .map(|k| own[k] * along[k].abs() + other[k] * along.dot(&edges(k)).abs())
                .sum();
            depth = kinetostat::number::smaller(depth, reach - along.dot(&apart).abs());
        }
        kinetostat::number::larger(depth, 0.0)
    }
}
