//! Compiles a chain ([`crate::batch::plan::steps`]): rigid offsets joined, redundant joints locked, springs inverted,
//! closed forms of inverse kinematics recognised; or gives the reason why it cannot.

use nalgebra::{DMatrix, Matrix3, Rotation3, Vector3};

use crate::batch::plan::steps::{
    Amount, Drive, Joint, Law, Plan, Polar, Rows, Screw, Search, Sphere, Spring, Step, Support,
    begins_at, halves_at, own_weight,
};
use crate::batch::status::NoKernel;
use crate::model::chain::{Chain, Element, Motion, Role};
use crate::model::kinematics::Kinematics;
use crate::model::springs::block::{SpringBlock, SpringLaw, if_curved, if_single};
use crate::model::springs::curved::CurvedLaw;
use crate::spatial::{MotionKind, Pose};

impl Plan {
    /// `end` is the pose of the platform in the frame of the limb's tip.
    pub fn new(chain: &Chain, end: &Pose) -> Result<Self, NoKernel> {
        let redundant = redundant_passive_joints(chain);
        let passive: Vec<usize> = chain
            .indices_of(Role::Passive)
            .into_iter()
            .filter(|i| !redundant.contains(i))
            .collect();
        if passive.len() > 6 {
            return Err(NoKernel::PassiveJoints(chain.name().to_owned()));
        }
        let mut writer = Writer {
            chain,
            passive: &passive,
            steps: Vec::new(),
            screws: Vec::new(),
            pending: (Matrix3::identity(), Vector3::zeros()),
        };
        writer.chain()?;
        writer.rigid(end);
        writer.flush();
        let mut passive_drives = Vec::new();
        let mut command_drives = Vec::new();
        let mut driven = vec![0; chain.coordinate_count()];
        for (screw, own) in writer.screws.iter().enumerate() {
            if let Some((index, ratio)) = own.coordinate {
                driven[index] += if ratio == 1.0 { 1 } else { 2 };
                if let Some(unknown) = passive.iter().position(|p| *p == index) {
                    passive_drives.push(Drive {
                        unknown,
                        screw,
                        ratio,
                    });
                }
            }
            if let Some((unknown, ratio)) = own.command {
                command_drives.push(Drive {
                    unknown,
                    screw,
                    ratio,
                });
            }
        }
        let sphere = sphere(&writer.steps, &writer.screws);
        let joints = passive.len();
        let search = |rows, passive, end| {
            writer.search(rows, passive, end, &passive_drives, &command_drives)
        };
        let searches = match &sphere {
            None => vec![search(Rows::Both, 0..joints, writer.steps.len())],
            Some(sphere) => vec![
                search(Rows::Position, 0..joints - 3, sphere.step),
                search(Rows::Rotation, joints - 3..joints, writer.steps.len()),
            ],
        };
        let length = chain.scale().length;
        let mut units = vec![1.0; chain.coordinate_count()];
        for screw in &writer.screws {
            if let (Some((own, _)), MotionKind::Prismatic) = (screw.coordinate, screw.kind) {
                units[own] = 1.0 / length;
            }
        }
        Ok(Self {
            units,
            passive_drives,
            one_each: driven.iter().all(|n| *n == 1),
            polar: sphere
                .as_ref()
                .and_then(|sphere| polar(&writer.steps[..sphere.step], &searches[0], chain)),
            searches,
            sphere,
            steps: writer.steps,
            screws: writer.screws,
            coordinates: chain.coordinate_count(),
            commands: chain.actuators().len(),
            home: chain.home_coordinates(),
            home_commands: chain.home_commands(),
            length,
            passive,
        })
    }
}

/// Passive joints whose motion others make as well, in general: locked where they are at home.
fn redundant_passive_joints(chain: &Chain) -> Vec<usize> {
    // A posture with nothing special about it.
    let nudge = |i: usize| 0.3 * ((i + 1) as f64 * 0.618_034).fract() - 0.1;
    let coordinates: Vec<f64> = chain
        .home_coordinates()
        .iter()
        .enumerate()
        .map(|(i, x)| match chain.coordinates()[i].role {
            Role::Passive => x + nudge(i),
            Role::Spring => *x,
        })
        .collect();
    let at = Kinematics::new(
        chain,
        &Pose::identity(),
        &coordinates,
        &chain.home_commands(),
    );
    let jacobian = at.jacobian(chain.tip());
    let length = chain.scale().length;
    let mut basis: Vec<nalgebra::DVector<f64>> = Vec::new();
    let mut redundant = Vec::new();
    for i in chain.indices_of(Role::Passive) {
        let mut column = nalgebra::DVector::from_fn(6, |k, _| {
            jacobian[(k, i)] * if k < 3 { 1.0 } else { length }
        });
        let size = column.norm();
        for _ in 0..2 {
            for b in &basis {
                let along = b.dot(&column);
                column.axpy(-along, b, 1.0);
            }
        }
        let left = column.norm();
        if left > 1e-9 * size {
            basis.push(column / left);
        } else {
            redundant.push(i);
        }
    }
    redundant
}

struct Writer<'c> {
    chain: &'c Chain,
    passive: &'c [usize],
    steps: Vec<Step>,
    screws: Vec<Screw>,
    /// Constant motion since the last step.
    pending: (Matrix3<f64>, Vector3<f64>),
}

impl Writer<'_> {
    /// A search for these passive joints, and for the commands unless it is one of rotations, on the steps up to `end`.
    fn search(
        &self,
        rows: Rows,
        passive: std::ops::Range<usize>,
        end: usize,
        passive_drives: &[Drive],
        command_drives: &[Drive],
    ) -> Search {
        let mut drives = Vec::new();
        let mut most = [self.chain.scale().length; 6];
        let mut add = |drive: &Drive, unknown: usize| {
            if unknown < 6 && self.screws[drive.screw].kind == MotionKind::Revolute {
                most[unknown] = 0.5;
            }
            drives.push(Drive { unknown, ..*drive });
        };
        for drive in passive_drives {
            if passive.contains(&drive.unknown) {
                add(drive, drive.unknown - passive.start);
            }
        }
        let commands = match rows {
            Rows::Rotation => 0,
            Rows::Position | Rows::Both => self.chain.actuators().len(),
        };
        for drive in command_drives.iter().filter(|_| commands > 0) {
            add(drive, passive.len() + drive.unknown);
        }
        Search {
            rows,
            passive,
            commands,
            end,
            drives,
            most,
        }
    }

    fn rigid(&mut self, pose: &Pose) {
        let (rotation, translation) = &mut self.pending;
        *translation += *rotation * pose.translation.vector;
        if pose.rotation.imag() != Vector3::zeros() {
            *rotation *= pose.rotation.to_rotation_matrix().matrix();
        }
    }

    fn flush(&mut self) {
        let (rotation, translation) = self.pending;
        if translation != Vector3::zeros() {
            self.steps.push(Step::Shift(translation.into()));
        }
        if rotation != Matrix3::identity() {
            let mut rows = [0.0; 9];
            rows.copy_from_slice(rotation.transpose().as_slice());
            self.steps.push(Step::Rotate(rows));
        }
        self.pending = (Matrix3::identity(), Vector3::zeros());
    }

    fn chain(&mut self) -> Result<(), NoKernel> {
        let chain = self.chain;
        let mut elements = chain.elements().iter();
        while let Some(element) = elements.next() {
            match element {
                Element::Rigid(pose) => self.rigid(pose),
                Element::Node(node) => {
                    for body in chain.bodies.iter().filter(|b| b.node == *node) {
                        self.steps.push(Step::Mass {
                            at: self.pending.1.into(),
                            mass: body.mass,
                        });
                    }
                    if let Some(mass) = halves_at(chain, *node) {
                        if begins_at(chain, *node) {
                            // Expressed in the axes of the segment.
                            self.flush();
                        }
                        self.steps.push(Step::Mass {
                            at: self.pending.1.into(),
                            mass,
                        });
                    }
                }
                Element::Motion(motion) => match block_of(chain, motion) {
                    Some(block) if block.len() > 1 => {
                        self.flush();
                        let motions = elements
                            .by_ref()
                            .take(block.len() - 1)
                            .map(|e| match e {
                                Element::Motion(m) => Some(*m),
                                _ => None,
                            })
                            .collect::<Option<Vec<_>>>();
                        let mut all = vec![*motion];
                        all.extend(motions.unwrap_or_default());
                        let mut spring = self.spring(block, &all)?;
                        spring.screw = self.screws.len();
                        self.screws.extend(all.iter().map(|m| Screw {
                            kind: m.kind,
                            coordinate: m.coordinate.map(|d| (d.index, 1.0)),
                            command: None,
                        }));
                        self.steps.push(Step::Spring(Box::new(spring)));
                    }
                    block => self.joint(motion, block)?,
                },
            }
        }
        Ok(())
    }

    fn joint(&mut self, motion: &Motion, block: Option<&SpringBlock>) -> Result<(), NoKernel> {
        let refusal = |spring: &str, what| Err(self.no_kernel(spring, what));
        let mut amount = Amount {
            fixed: 0.0,
            command: motion.command.map(|d| (d.index, d.ratio)),
            coordinate: motion.coordinate.map(|d| (d.index, d.ratio)),
        };
        let (mut support, mut law) = (Support::Fixed, None);
        if let Some((index, ratio)) = amount.coordinate {
            let own = &self.chain.coordinates()[index];
            match (own.role, block) {
                (Role::Spring, Some(block)) => {
                    law = if_single!(&block.law, _own => Some(Box::new(block.law.clone())), else None);
                    if law.is_none() && !matches!(block.law, SpringLaw::Linear(_)) {
                        return refusal(&block.name, "has a law that no kernel knows");
                    }
                    let k = block.stiffness_at(&self.chain.home_coordinates());
                    let drives = self.chain.elements().iter().filter(|e| {
                        matches!(e, Element::Motion(m) if m.coordinate.is_some_and(|d| d.index == index))
                    });
                    if drives.count() > 1 || ratio != 1.0 {
                        return refusal(&own.name, "moves several joints");
                    }
                    if own.home != 0.0 || block.rest[0] != 0.0 {
                        return refusal(&own.name, "is preloaded");
                    }
                    support = Support::Spring(1.0 / k[(0, 0)]);
                }
                (Role::Spring, None) => {
                    return refusal(&own.name, "has no law");
                }
                (Role::Passive, _) => {
                    if let Some(slot) = self.passive.iter().position(|i| *i == index) {
                        support = Support::Passive(slot);
                    }
                }
            }
        }
        let (axis, sign, turned) = along_an_axis(motion);
        if let Some(turned) = &turned {
            self.pending.0 *= turned;
        }
        self.flush();
        for (_, ratio) in amount.command.iter_mut().chain(&mut amount.coordinate) {
            *ratio *= sign;
        }
        // A locked joint keeps its value at home.
        if matches!(support, Support::Fixed)
            && let Some((index, ratio)) = amount.coordinate.take()
        {
            amount.fixed = ratio * self.chain.coordinates()[index].home;
        }
        let screw = self.screws.len();
        self.screws.push(Screw {
            kind: motion.kind,
            coordinate: amount.coordinate,
            command: amount.command,
        });
        self.steps.push(Step::Joint(Joint {
            kind: motion.kind,
            axis,
            amount,
            support,
            law,
            screw,
        }));
        if let Some(turned) = turned {
            self.pending.0 = turned.transpose();
        }
        Ok(())
    }

    fn no_kernel(&self, spring: &str, what: &'static str) -> NoKernel {
        NoKernel::Spring {
            limb: self.chain.name().to_owned(),
            spring: spring.to_owned(),
            what,
        }
    }

    fn spring(&self, block: &SpringBlock, motions: &[Motion]) -> Result<Spring, NoKernel> {
        let refusal = |what| Err(self.no_kernel(&block.name, what));
        let law = match &block.law {
            SpringLaw::Linear(_) => Law::Constant,
            SpringLaw::Parallelogram(law) => {
                match self.passive.iter().position(|i| *i == law.inclination) {
                    Some(slot) => Law::Parallelogram(law.clone(), slot),
                    None => return refusal("hangs on a redundant joint"),
                }
            }
            other => {
                let own = if_curved!(other, law => Some(law.matrix()), else None);
                let Some(strains) = own.and_then(|k| k.cholesky()).map(|c| c.inverse()) else {
                    return refusal("has a law that no kernel knows");
                };
                let rows = std::array::from_fn(|i| strains[(i / 6, i % 6)]);
                Law::Curved(other.clone(), Box::new(rows))
            }
        };
        let k = &block.stiffness_at(&self.chain.home_coordinates());
        if block.len() > 6 || motions.len() != block.len() {
            return refusal("is not in one place");
        }
        let mut directions = Vec::new();
        for (i, motion) in motions.iter().enumerate() {
            let along = (0..3).find(|k| motion.axis[*k] == 1.0);
            let ours = motion.command.is_none()
                && motion
                    .coordinate
                    .is_some_and(|d| d.index == block.first + i && d.ratio == 1.0);
            match (along, motion.kind) {
                (Some(axis), MotionKind::Prismatic) if ours => directions.push(axis),
                (Some(axis), MotionKind::Revolute) if ours => directions.push(axis + 3),
                _ => return refusal("is not in one place"),
            }
        }
        if directions.windows(2).any(|w| w[0] >= w[1]) {
            return refusal("turns before it slides");
        }
        let own = block.first..block.first + block.len();
        let home = &self.chain.coordinates()[own];
        if block.rest.iter().any(|x| *x != 0.0) || home.iter().any(|c| c.home != 0.0) {
            return refusal("is preloaded");
        }
        let Some(inverse) = k.clone().cholesky().map(|c| c.inverse()) else {
            return refusal("is singular");
        };
        let mut coordinates = [None; 6];
        for (i, d) in directions.iter().enumerate() {
            coordinates[*d] = Some(block.first + i);
        }
        let masses = self.steps.iter();
        let masses = masses.filter(|s| matches!(s, Step::Mass { .. }));
        let own_weight = match own_weight(self.chain, block, &coordinates, masses.count()) {
            Ok(own) => own,
            Err(what) => return refusal(what),
        };
        let spread = |m: &DMatrix<f64>| {
            let mut full = Box::new([0.0; 36]);
            for (i, r) in directions.iter().enumerate() {
                for (j, c) in directions.iter().enumerate() {
                    full[6 * r + c] = m[(i, j)];
                }
            }
            full
        };
        Ok(Spring {
            coordinates,
            screw: 0,
            moving: directions.len(),
            compliance: spread(&inverse),
            stiffness: spread(k),
            law,
            own_weight,
        })
    }
}

/// The spring that holds a motion.
fn block_of<'c>(chain: &'c Chain, motion: &Motion) -> Option<&'c SpringBlock> {
    let index = motion.coordinate?.index;
    let mut springs = chain.springs().iter();
    springs.find(|s| (s.first..s.first + s.len()).contains(&index))
}

/// Coordinate axis, sense and, for a slanted axis, the rotation that leads z onto it.
fn along_an_axis(motion: &Motion) -> (usize, f64, Option<Matrix3<f64>>) {
    for k in 0..3 {
        if motion.axis[k].abs() == 1.0 {
            return (k, motion.axis[k], None);
        }
    }
    let turned = Rotation3::rotation_between(&Vector3::z(), &motion.axis)
        .map_or_else(Matrix3::identity, |r| *r.matrix());
    (2, 1.0, Some(turned))
}

/// The spherical joint at the end of a limb, if there is one.
fn sphere(steps: &[Step], screws: &[Screw]) -> Option<Sphere> {
    let last = steps.iter().rposition(|s| matches!(s, Step::Joint(_)))?;
    let first = last.checked_sub(2)?;
    let mut axes = [false; 3];
    for step in &steps[first..=last] {
        let Step::Joint(joint) = step else {
            return None;
        };
        let (Support::Passive(_), Some((own, ratio))) = (joint.support, joint.amount.coordinate)
        else {
            return None;
        };
        let drives = screws
            .iter()
            .filter(|s| s.coordinate.is_some_and(|(c, _)| c == own));
        if joint.kind != MotionKind::Revolute
            || joint.amount.command.is_some()
            || ratio.abs() != 1.0
            || drives.count() > 1
        {
            return None;
        }
        axes[joint.axis] = true;
    }
    let (mut rotation, mut point) = (Matrix3::identity(), Vector3::zeros());
    for step in &steps[last + 1..] {
        match step {
            Step::Shift(l) => point += rotation * Vector3::from(*l),
            Step::Rotate(r) => rotation *= Matrix3::from_row_slice(r),
            Step::Mass { .. } => {}
            Step::Joint(_) | Step::Spring(_) => return None,
        }
    }
    axes.iter().all(|a| *a).then(|| Sphere {
        step: first,
        arm: (rotation.transpose() * point).into(),
    })
}

/// The polar joints that lead to the centre of a spherical joint, if these steps are that.
fn polar(steps: &[Step], search: &Search, chain: &Chain) -> Option<Polar> {
    let first = steps.iter().position(|s| matches!(s, Step::Joint(_)))?;
    let (Step::Joint(a), Step::Joint(b)) = (&steps[first], steps.get(first + 1)?) else {
        return None;
    };
    if search.drives.len() != 3 || search.passive.len() != 2 || search.commands != 1 {
        return None;
    }
    let (mut rotation, mut point) = (Matrix3::identity(), Vector3::zeros());
    for step in &steps[..first] {
        match step {
            Step::Shift(l) => point += rotation * Vector3::from(*l),
            Step::Rotate(r) => rotation *= Matrix3::from_row_slice(r),
            Step::Mass { .. } => {}
            Step::Joint(_) | Step::Spring(_) => return None,
        }
    }
    let at_home = |joint: &Joint| -> Option<(f64, f64)> {
        let (index, ratio) = joint.amount.coordinate?;
        let free = matches!(joint.support, Support::Passive(_));
        let turns = joint.kind == MotionKind::Revolute && ratio.abs() == 1.0;
        let home = joint.amount.fixed + ratio * chain.coordinates()[index].home;
        (free && turns && joint.amount.command.is_none()).then(|| home.sin_cos())
    };
    let home = [at_home(a)?, at_home(b)?];
    if a.axis == b.axis {
        return None;
    }
    let along = 3 - a.axis - b.axis;
    let (mut fixed, mut slide) = (0.0, None);
    for step in &steps[first + 2..] {
        match step {
            Step::Spring(_) | Step::Mass { .. } => {}
            Step::Shift(l) if l[a.axis] == 0.0 && l[b.axis] == 0.0 => fixed += l[along],
            Step::Joint(joint)
                if joint.kind == MotionKind::Prismatic
                    && joint.axis == along
                    && !matches!(joint.support, Support::Passive(_))
                    && slide.is_none() =>
            {
                fixed += joint.amount.fixed;
                slide = joint.amount.command;
            }
            _ => return None,
        }
    }
    let (command, ratio) = slide?;
    let length = fixed + ratio * chain.home_commands()[command];
    let mut rows = [0.0; 9];
    rows.copy_from_slice(rotation.transpose().as_slice());
    (length != 0.0 && ratio != 0.0).then(|| Polar {
        first,
        axes: [a.axis, b.axis],
        rotation: rows,
        point: point.into(),
        command,
        fixed,
        ratio,
        sign: length.signum(),
        home,
    })
}
