//! Round rods with a rigid tool ahead, pressed beyond their load: one fork, one family of shapes, however little
//! they stretch.

use kinetostat::{
    Chain, ChainProblem, CurveSettings, EndCondition, LinkSpec, Parameter, Pose, Settings, Wrench,
    continuation::SpecialKind, follow, solve_chain,
};
use nalgebra::{Vector3, vector};

use super::random::Random;
use super::rod::slender;

/// A clamped rod of unit length and bending stiffness.
#[derive(Clone, Copy, Debug)]
pub struct RoundRod {
    pub segments: usize,
    /// EA, N.
    pub axial: f64,
    /// Length of the tool, m.
    pub tool: f64,
}

impl RoundRod {
    pub fn chain(&self) -> Chain {
        let link = LinkSpec::beam(slender(self.axial), 1.0).segments(self.segments);
        let chain = Chain::builder("rod").link_with("rod", &link);
        let chain = chain.rigid(Pose::translation(self.tool, 0.0, 0.0));
        chain.build().expect("a rod")
    }

    /// `k L tan(k L) = L / a`, `P = k^2 EI` (Timoshenko and Gere, Theory of Elastic Stability, 1961, 2.4).
    pub fn critical(&self) -> f64 {
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match middle * middle.tan() * self.tool < 1.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        low * low
    }

    /// What a curve up to some times the load tells wrongly, in words.
    pub fn difference(&self, times: f64) -> Option<String> {
        let chain = self.chain();
        let rest = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let start = solve_chain(&rest, &Settings::default()).expect("at rest");
        let pushed = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros());
        let critical = self.critical();
        let mut settings = CurveSettings::within(0.0, times * critical);
        settings.branches = 8;
        let grown = Parameter::end_wrench(pushed);
        let curves = follow(&rest, &grown, &start, 0.0, &settings).expect("a path from rest");
        let [fork] = &curves.specials[..] else {
            return Some(format!("{} named points", curves.specials.len()));
        };
        let coarse = 0.002 + 0.3 / (self.segments * self.segments) as f64;
        let off = fork.point.parameter / critical - 1.0;
        if fork.kind != (SpecialKind::Multiple { modes: 2 }) || off.is_nan() || off.abs() > coarse {
            return Some(format!("{:?} off by {off:e}", fork.kind));
        }
        // A half of the branch may be lost beside very stiff springs, if it is said.
        let others = &curves.branches[1..];
        if others.len() > 1 || (others.is_empty() && !fork.lost_branch) {
            return Some(format!("{} branches", curves.branches.len()));
        }
        let points = others.iter().flat_map(|bent| &bent.points);
        let beyond = points.filter(|p| p.parameter > 1.01 * critical);
        let mut wrong = beyond
            .filter(|p| !(p.in_family() && p.dead_load.stable && p.displacement_control.stable));
        wrong
            .next()
            .map(|p| format!("does not stay at {}", p.parameter))
    }
}

/// One rod.
pub fn case(random: &mut Random) {
    let rod = RoundRod {
        segments: 3 + random.below(10),
        axial: random.power(4.0, 12.0),
        tool: random.below(2) as f64 * random.between(0.0, 0.5),
    };
    if let Some(difference) = rod.difference(random.between(1.02, 1.3)) {
        panic!("{rod:?}: {difference}");
    }
}
