//! Stiffness with platforms between: rods in series as one chain and with a platform behind every rod.

use kinetostat::{
    Chain, ChainBuilder, Direction, Limb, LinkSpec, Mechanism, Platform, Pose, Wrench,
    spatial::pose_residual,
};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Vector3, Vector6, vector};

use super::random::Random;
use super::rod::slender;

/// Rods in series from the base to the tool, with a platform after each.
#[derive(Clone, Debug)]
pub struct Series {
    /// Where every rod begins, against the end of the one before, and its length, m.
    pub rods: Vec<(Pose, f64)>,
    /// EA, N; they bend with 1 N m2.
    pub axial: f64,
    /// Of a body on every rod, kg.
    pub mass: f64,
}

impl Series {
    /// Two to four rods at angles to each other.
    pub fn random(random: &mut Random, axial: f64, mass: f64) -> Self {
        let count = 2 + random.below(3);
        let rods = (0..count).map(|_| {
            let turn = Pose::new(random.vector(0.05), random.vector(0.8));
            (turn, random.between(0.2, 0.5))
        });
        let rods = rods.collect();
        Self { rods, axial, mass }
    }

    fn rod(&self, chain: ChainBuilder, i: usize) -> ChainBuilder {
        let (turn, length) = self.rods[i];
        let half = LinkSpec::beam(slender(self.axial), 0.5 * length).segments(4);
        let chain = chain.rigid(turn).link_with(&format!("near {i}"), &half);
        let name = format!("body {i}");
        let chain = match self.mass > 0.0 {
            true => chain.body(&name, self.mass, vector![0.0, 0.01, 0.02], Matrix3::zeros()),
            false => chain,
        };
        chain.link_with(&format!("far {i}"), &half)
    }

    fn end(&self, i: usize) -> Pose {
        let (turn, length) = self.rods[i];
        turn * Pose::translation(length, 0.0, 0.0)
    }

    pub fn home(&self) -> Pose {
        (0..self.rods.len()).fold(Pose::identity(), |pose, i| pose * self.end(i))
    }

    fn gravity(&self) -> Vector3<f64> {
        vector![1.0, -3.0, -9.0]
    }

    pub fn as_one_chain(&self) -> Mechanism {
        let mut chain = Chain::builder("rods");
        for i in 0..self.rods.len() {
            chain = self.rod(chain, i);
        }
        let chain = chain.build().expect("a chain");
        Mechanism::serial(chain, self.home(), self.gravity()).expect("a machine")
    }

    /// With a platform behind every rod; limbs in another order than the rods if `mixed`.
    pub fn as_platforms(&self, mixed: bool) -> Mechanism {
        let mut builder = Mechanism::builder("rods").gravity(self.gravity());
        let mut home = Pose::identity();
        let mut limbs = Vec::new();
        for i in 0..self.rods.len() {
            home *= self.end(i);
            let name = match i + 1 == self.rods.len() {
                true => "tool".to_owned(),
                false => format!("platform {i}"),
            };
            let to = builder.platform(Platform::new(&name, home));
            let name = format!("rod {i}");
            let chain = self.rod(Chain::builder(&name), i).build().expect("a rod");
            limbs.push(Limb::between(name, to - 1, to, chain));
        }
        if mixed {
            limbs.reverse();
        }
        let with_limbs = limbs
            .into_iter()
            .fold(builder, |builder, limb| builder.limb(limb));
        with_limbs.build().expect("a machine")
    }

    /// What differs between both under a load on the tool, in words; `None` where either does not come to rest.
    pub fn difference(&self, mixed: bool, load: &Wrench) -> Option<Result<(), String>> {
        let (one, many, home) = (self.as_one_chain(), self.as_platforms(mixed), self.home());
        let one = one.posture(&home).expect("home");
        let many = many.posture(&home).expect("home");
        let unloaded = [&one, &many].map(|p| p.stiffness().expect("a stiffness"));
        let [a, b] = unloaded.each_ref().map(|k| (&k.directions[..], k.length));
        let off = apart(a, b);
        if off.is_nan() || off > 1e-7 {
            return Some(Err(format!("unloaded stiffnesses are {off:e} apart")));
        }
        let (Ok(a), Ok(b)) = (one.deflected_by(load), many.deflected_by(load)) else {
            return None;
        };
        let off = pose_residual(&a.tool, &b.tool).0.norm();
        // Beyond the critical load there are more shapes than one, and beside very stiff springs the way to the stable
        // one may be lost: what is found is compared, not which.
        if off > 1e-3 && (a.stable() || b.stable()) {
            return None;
        }
        if off.is_nan() || off > 1e-8 {
            let stay = [a.stable(), b.stable()];
            return Some(Err(format!("tools are {off:e} apart, {stay:?}")));
        }
        let off = apart((&a.directions, a.length), (&b.directions, b.length));
        // Weights turn against the rods: there the tangent holds as many digits as EA leaves.
        let share = if self.mass > 0.0 { 1e-15 } else { 4e-18 };
        if off.is_nan() || off > 1e-6 + share * self.axial {
            return Some(Err(format!("loaded stiffnesses are {off:e} apart")));
        }
        let stay = [&a, &b].map(|e| (e.platform.stable, e.platform.free));
        if stay[0] != stay[1] {
            return Some(Err(format!("as one chain and with platforms: {stay:?}")));
        }
        Some(Ok(()))
    }
}

/// Signs and rows with `K = sum s r r^T`, and motions to which they answer with one.
pub fn rows(directions: &[Direction], length: f64) -> Vec<(f64, Vector6<f64>, Vector6<f64>)> {
    let unit = Vector6::from_fn(|i, _| if i < 3 { 1.0 } else { length });
    let finite = directions
        .iter()
        .filter(|d| d.stiffness_n_per_m.is_finite() && d.stiffness_n_per_m != 0.0);
    finite
        .map(|d| {
            let motion = d.twist.0.component_mul(&unit).normalize();
            let root = d.stiffness_n_per_m.abs().sqrt();
            (
                d.stiffness_n_per_m.signum(),
                motion.component_mul(&unit) * root,
                motion.component_div(&unit) / root,
            )
        })
        .collect()
}

/// How far two sets of principal directions are from the same stiffness, where motions are measured so that every
/// stiffness of the first is one; infinite where one has more than the other.
pub fn apart(a: (&[Direction], f64), b: (&[Direction], f64)) -> f64 {
    let (own, other) = (rows(a.0, a.1), rows(b.0, b.1));
    if own.len() != other.len() {
        return f64::INFINITY;
    }
    let mut worst = Worst::new();
    for (i, (sign, _, first)) in own.iter().enumerate() {
        for (j, (_, _, second)) in own.iter().enumerate() {
            let parts = other
                .iter()
                .map(|(s, r, _)| s * r.dot(first) * r.dot(second));
            worst.add(parts.sum::<f64>() - if i == j { *sign } else { 0.0 });
        }
    }
    // Two sets without a direction are the same.
    if own.is_empty() { 0.0 } else { worst.value() }
}

/// One machine of rods in series.
pub fn case(random: &mut Random) {
    let axial = random.power(1.0, 13.0);
    let mass = match random.once_in(2) && axial < 1e10 {
        true => 0.05,
        false => 0.0,
    };
    let series = Series::random(random, axial, mass);
    let force = random.axis() * random.between(0.0, 12.0);
    let load = Wrench::new(force, random.vector(0.2));
    let mixed = random.once_in(2);
    if let Some(Err(difference)) = series.difference(mixed, &load) {
        panic!("{series:?}, {load:?}: {difference}");
    }
}
