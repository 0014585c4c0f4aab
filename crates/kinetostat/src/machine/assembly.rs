//! Limbs with errors of manufacture and assembly, to first order [R 6.15-6.20]. The exact answer is
//! an equilibrium of the actual geometry without a load.

use nalgebra::DMatrix;

use crate::error::{Error, Result};
use crate::machine::network::Network;
use crate::machine::platform_system::PlatformSystem;
use crate::machine::posture::Posture;
use crate::spatial::{Twist, Wrench, pose_residual};

/// First-order assembly of limbs with errors, without a load or under one [R 6.15-6.20].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LinearAssembly {
    /// Motion of the tool from its nominal target.
    pub shift: Twist,
    /// Motion of every platform from its nominal place, the base (zero) first.
    pub platforms: Vec<Twist>,
    /// Wrench on every limb's tip, base axes; on every platform they add up to the load on it.
    pub wrenches: Vec<Wrench>,
    /// Change of the passive joints of every limb, m or rad.
    pub passive: Vec<Vec<f64>>,
    /// Deflection of the springs of every limb, m or rad.
    pub springs: Vec<Vec<f64>>,
}

impl Posture {
    /// Displacement of the tip of every unloaded actual limb from its nominal place, `eps_i`, base axes, its base where
    /// it is nominally.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let build = |arm: Vector3<f64>| {
    /// #     Chain::builder("gantry").actuator("x", slide(Vector3::x())).translation(arm).build()
    /// # };
    /// // An arm of 0.5 m that came out 0.1 mm too long and hangs 0.3 mm.
    /// let (drawn, made) = (vector![0.0, 0.5, 0.0], vector![0.0, 0.5001, -3e-4]); // m
    /// let limb = Limb::between("gantry", 0, 1, build(drawn)?).with_actual(build(made)?);
    /// let home = Pose::translation(0.0, 0.5, 0.0);
    /// let mut machine = Mechanism::builder("gantry");
    /// machine.platform(Platform::new("tool", home));
    /// let gantry = machine.limb(limb).build()?;
    /// let errors = gantry.posture(&home)?.assembly_errors();
    /// assert!((errors[0].linear() - (made - drawn)).norm() < 1e-15 && errors[0].angular().norm() == 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn assembly_errors(&self) -> Vec<Twist> {
        let m = &self.mechanism;
        m.limbs()
            .iter()
            .zip(&self.limbs)
            .map(|(limb, joints)| {
                let base = self.platforms[limb.from];
                let tip = |chain| {
                    crate::model::kinematics::unloaded_tip(
                        chain,
                        &base,
                        &joints.coordinates,
                        &joints.commands,
                    )
                };
                pose_residual(&tip(&limb.actual), &tip(&limb.nominal))
            })
            .collect()
    }

    /// First-order platform shift and internal wrenches for given limb errors `eps_i` (base axes,
    /// at each limb's tip), no external load:
    /// `Dt = (sum A^T K A)^-1 sum A^T K eps`, `F_i = K_i (A_i Dt - eps_i)`, with `A_i` the motion of
    /// the tip by those of the limb's platforms. Where a limb cannot move, `N_i^T (A_i Dt - eps_i) =
    /// 0` and it carries what is needed; errors that such limbs cannot follow are met as nearly as
    /// can be (least squares), as an infinite wrench is nobody's answer.
    ///
    /// # Errors
    /// Wrong sizes only.
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
    /// let posture = arm.posture(&home)?;
    /// let error = Twist::new(vector![0.0, 1e-3, 0.0], Vector3::zeros()); // m, at the limb's tip
    /// let assembled = posture.linear_assembly(&[error])?;
    /// assert!((assembled.shift - error).0.norm() < 1e-12, "a single limb takes the tool along");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn linear_assembly(&self, errors: &[Twist]) -> Result<LinearAssembly> {
        self.linear_assembly_under(errors, &Wrench::zero())
    }

    /// Assembles like [`Self::linear_assembly`] with a wrench on the tool (about its origin, base axes) besides:
    /// `Dt = (sum A^T K A)^-1 (sum A^T K eps + W)`. Weights, preloads and loads on limbs are left out. Free directions
    /// of the tool do not move.
    ///
    /// # Errors
    /// Wrong sizes; a wrench that is not finite.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let leg = |name: &str, x: f64| {
    /// #     Chain::builder(name)
    /// #         .translation(vector![x, 0.0, 0.0])
    /// #         .actuator("slide", ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 2e6)) // N/m
    /// #         .passive_spherical("ball")
    /// #         .build()
    /// # };
    /// # let mut machine = Mechanism::builder("table");
    /// # let tool = machine.platform(Platform::new("top", Pose::identity()));
    /// # for (name, x) in [("left", -0.2), ("right", 0.2)] {
    /// #     let limb = Limb::between(name, 0, tool, leg(name, x)?);
    /// #     machine = machine.limb(limb.fixed_at(Pose::translation(x, 0.0, 0.0)));
    /// # }
    /// # let table = machine.build()?;
    /// let posture = table.posture(&Pose::identity())?;
    /// // The right leg of two came out 1 mm too long, and a weight stands in the middle.
    /// let long = Twist::new(vector![0.0, 0.0, 1e-3], Vector3::zeros()); // m
    /// let weight = Wrench::new(vector![0.0, 0.0, -1000.0], Vector3::zeros()); // N
    /// let assembled = posture.linear_assembly_under(&[Twist::zero(), long], &weight)?;
    /// // The top tilts by 1 mm over 0.4 m, its middle rises by half of that and sinks on two legs of 2e6 N/m.
    /// assert!((assembled.shift.linear().z - (5e-4 - 1000.0 / 4e6)).abs() < 1e-12);
    /// assert!((assembled.shift.angular().y + 1e-3 / 0.4).abs() < 1e-12);
    /// // No leg is strained by the error: each carries half of the weight.
    /// assert!(assembled.wrenches.iter().all(|leg| (leg.force().z + 500.0).abs() < 1e-6));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn linear_assembly_under(
        &self,
        errors: &[Twist],
        wrench: &Wrench,
    ) -> Result<LinearAssembly> {
        self.finite("the wrench", wrench.0.iter())?;
        let m = &self.mechanism;
        if errors.len() != m.limbs().len() {
            return Err(Error::Size {
                place: m.place(),
                what: "limb errors",
                expected: m.limbs().len(),
                found: errors.len(),
            });
        }
        let network = Network::new(self)?;
        let (moving, rows) = (network.moving(), network.rows());
        let (size, count) = (6 * moving, rows.count());
        let mut b = DMatrix::zeros(size + count, 1);
        {
            let mut tool = b.fixed_view_mut::<6, 1>(6 * (m.tool() - 1), 0);
            tool += wrench.0;
        }
        let mut at = size;
        for (i, error) in errors.iter().enumerate() {
            let pull = network.limbs[i].cartesian.matrix * error.0;
            let ends = &network.motions[i];
            for (platform, by) in [&ends.to, &ends.from] {
                if *platform > 0 {
                    let mut view = b.fixed_view_mut::<6, 1>(6 * (platform - 1), 0);
                    view += by.transpose() * pull;
                }
            }
            let k = network.rigid[i].ncols();
            b.view_mut((at, 0), (k, 1))
                .copy_from(&(network.rigid[i].transpose() * error.0));
            at += k;
        }
        PlatformSystem::new(network.stiffness(), &rows, m.scale()).solve(&mut b);
        let mut platforms = vec![Twist::zero()];
        platforms.extend((0..moving).map(|p| Twist(b.fixed_view::<6, 1>(6 * p, 0).into_owned())));
        let carried: Vec<f64> = b.rows(size, count).iter().copied().collect();
        let mut result = LinearAssembly {
            shift: platforms[m.tool()],
            wrenches: network.wrenches(&platforms, errors, &carried),
            passive: Vec::new(),
            springs: Vec::new(),
            platforms,
        };
        for (i, k) in network.limbs.iter().enumerate() {
            let motion = network.motions[i].of(&result.platforms).0 - errors[i].0;
            let list = |m: &DMatrix<f64>| (m * motion).iter().copied().collect();
            result.passive.push(list(&k.passive));
            result.springs.push(list(&k.springs));
        }
        Ok(result)
    }
}
