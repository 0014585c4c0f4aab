//! Points of the curves of a chain: those with names, the jumps between them, and the branches.

use kinetostat::{
    Parameter,
    continuation::{BranchEnd, CurvePoint, Curves, Jump, Special, SpecialKind},
};
use kinetostat_analysis::rotation::ContinuousRotation;
use kinetostat_analysis::serial_chain::SerialChain;
use nalgebra::Vector3;

use crate::curve::answer::{BranchAnswer, JumpAnswer, NamedPoint, PointAnswer, kind_name, letter};
use crate::curve::query::CurveQuery;
use crate::curve::state::CurveState;
use crate::end_condition::chain::{mode_in_words, values};

/// Curves as they are shown.
pub(crate) struct View<'v> {
    pub(crate) chain: &'v SerialChain,
    pub(crate) q: &'v CurveQuery,
    pub(crate) curves: &'v Curves<'v>,
    pub(crate) rotation: ContinuousRotation,
}

impl View<'_> {
    /// `more`: what a continuous rotation has more than the one within half a turn, about the moment
    /// that grows, rad.
    pub(crate) fn point(&self, p: &CurvePoint, more: &Vector3<f64>) -> PointAnswer {
        let e = &p.equilibrium;
        CurveState {
            parameter: p.parameter,
            conjugate: p.conjugate,
            slope: p.slope,
            stable: [p.dead.stable, p.held.stable],
            may_flutter: p.dead.may_flutter(),
            share_to_buckling: e.stability.share_to_buckling,
            energy: e.energy,
            wrench: e.wrench,
            tip: e.tip,
            coordinates: values(self.chain, &e.coordinates),
        }
        .answer(self.q, self.about(more))
    }

    /// The part of a rotation vector about the growing moment.
    pub(crate) fn about(&self, rotation: &Vector3<f64>) -> f64 {
        match &self.q.parameter {
            Parameter::Load(pattern) => {
                let axis = pattern.end.moment().try_normalize(0.0);
                axis.map_or(0.0, |axis| rotation.dot(&axis))
            }
            Parameter::Displacement(_) => 0.0,
        }
    }

    /// Points with names, and the jumps between them. `start`: parameter and conjugate where the curve starts.
    pub(crate) fn named(
        &self,
        start: (f64, f64),
        jumps: &[Jump],
    ) -> (Vec<NamedPoint>, Vec<JumpAnswer>) {
        let first = self.nearest_to_start(start);
        let mut names = Names {
            view: self,
            list: Vec::new(),
        };
        if let Some(p) = first {
            let words = "where the curve starts".into();
            names.add("start", words, vec![1], p, &[], [false; 2]);
        }
        let specials: Vec<String> = self
            .curves
            .specials
            .iter()
            .map(|s| names.special(s))
            .collect();
        let jumps = jumps
            .iter()
            .map(|jump| names.jump(jump, &specials[jump.from]))
            .collect();
        for k in 0..self.curves.branches.len() {
            names.ends(k, first);
        }
        (names.list, jumps)
    }

    /// The point of the start's own branch where the curve starts.
    fn nearest_to_start(&self, start: (f64, f64)) -> Option<&CurvePoint> {
        // A locked chain has many points at the start's displacement: the load tells them apart.
        let width = self.q.range.1 - self.q.range.0;
        let off = |p: &CurvePoint| {
            (p.parameter - start.0).abs() / width
                + (p.conjugate - start.1).abs() / (1.0 + start.1.abs())
        };
        let own = self.curves.branches.first()?;
        own.points.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    pub(crate) fn branches(&self, named: &[NamedPoint]) -> Vec<BranchAnswer> {
        self.curves
            .branches
            .iter()
            .enumerate()
            .map(|(k, b)| BranchAnswer {
                number: k + 1,
                // The start is named first, then the special points in their order.
                from: b
                    .origin
                    .and_then(|s| named.get(s + 1))
                    .map(|n| n.name.clone()),
                ends: b.ends,
                points: b
                    .points
                    .iter()
                    .enumerate()
                    .map(|(i, p)| self.point(p, &self.rotation.of_point(self.curves, k, i)))
                    .collect(),
            })
            .collect()
    }
}

/// Points as they get their names: A, B, C and so on.
struct Names<'n> {
    view: &'n View<'n>,
    list: Vec<NamedPoint>,
}

impl Names<'_> {
    fn add(
        &mut self,
        kind: &'static str,
        words: String,
        branches: Vec<usize>,
        p: &CurvePoint,
        mode: &[f64],
        limits: [bool; 2],
    ) -> String {
        let view = self.view;
        let name = letter(self.list.len());
        self.list.push(NamedPoint {
            name: name.clone(),
            kind,
            in_words: words,
            branches,
            mode: mode.to_vec(),
            mode_in_words: if mode.is_empty() {
                String::new()
            } else {
                mode_in_words(view.chain, mode)
            },
            limits,
            point: view.point(p, &view.rotation.at(view.curves, p)),
        });
        name
    }

    fn special(&mut self, s: &Special) -> String {
        let branches: Vec<usize> = s.branches.iter().map(|b| b + 1).collect();
        self.add(
            kind_name(s.kind),
            special_in_words(s),
            branches,
            &s.point,
            &s.mode,
            limits(s),
        )
    }

    fn jump(&mut self, jump: &Jump, from: &str) -> JumpAnswer {
        let (under, words) = match jump.dead_load {
            true => ("dead_load", "under a dead load"),
            false => ("prescribed_motion", "under prescribed motion"),
        };
        let to = jump.to.iter().map(|p| {
            let branch = self.view.chain.nearest_branch(self.view.curves, p) + 1;
            let words = format!("where the jump from {from} {words} may land");
            self.add("landing", words, vec![branch], p, &[], [false; 2])
        });
        let to = to.collect();
        JumpAnswer {
            from: from.to_owned(),
            under,
            to,
        }
    }

    /// Both ends of a branch, but for those that are the start, which has a name already.
    fn ends(&mut self, k: usize, start: Option<&CurvePoint>) {
        let branch = &self.view.curves.branches[k];
        let is_start = |p: &CurvePoint| {
            start.is_some_and(|o| p.parameter == o.parameter && p.conjugate == o.conjugate)
        };
        let ends = [branch.points.first(), branch.points.last()];
        for (p, end) in ends.into_iter().zip(branch.ends) {
            let words = match end {
                BranchEnd::Range => "leaves the range",
                BranchEnd::Angle => "a joint has turned by 180 deg",
                BranchEnd::Points => "as many points as allowed",
                BranchEnd::Lost => "no further point was found",
                BranchEnd::Stalled => "ever shorter steps made no progress",
                _ => continue,
            };
            if let Some(p) = p.filter(|p| k > 0 || !is_start(p)) {
                let words = format!("end of branch {}: {words}", k + 1);
                self.add("end", words, vec![k + 1], p, &[], [false; 2]);
            }
        }
    }
}

/// Whether stability ends at a special point: under a dead load, under prescribed motion.
pub(crate) fn limits(s: &Special) -> [bool; 2] {
    if !s.stable_side {
        return [false; 2];
    }
    match s.kind {
        SpecialKind::LoadLimit => [true, false],
        SpecialKind::DisplacementLimit => [false, true],
        // The verdict of the point itself is a matter of rounding: it is at the limit of what holds.
        _ => [s.point.slope >= 0.0, true],
    }
}

fn special_in_words(s: &Special) -> String {
    let tail = if s.stable_side {
        ""
    } else {
        ", on a part of the curve that is unstable anyway"
    };
    let text = match s.kind {
        SpecialKind::LoadLimit if s.stable_side => {
            "the load has its extreme here: under a dead load the chain snaps".to_owned()
        }
        SpecialKind::DisplacementLimit if s.stable_side => {
            "the motion has its extreme here: under prescribed motion the chain snaps".to_owned()
        }
        SpecialKind::LoadLimit => "extreme of the load".to_owned(),
        SpecialKind::DisplacementLimit => "extreme of the motion".to_owned(),
        SpecialKind::Pitchfork if s.stable_side => {
            "pitchfork: the chain buckles to one side or the other".to_owned()
        }
        SpecialKind::Pitchfork => "pitchfork: two mirrored shapes branch off".to_owned(),
        SpecialKind::Transcritical => "two branches cross and both go on".to_owned(),
        SpecialKind::StabilityChange => {
            "stability changes here without a limit: another branch crosses".to_owned()
        }
        SpecialKind::Multiple { modes } => format!("{modes} modes become critical together"),
        _ => "special point".to_owned(),
    };
    format!("{text}{tail}")
}
