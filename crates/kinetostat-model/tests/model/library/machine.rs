//! From a model's document and the joints of a posture to a [`Structure`]: the file's words are
//! read here a second time.

use std::collections::BTreeMap;

use kinetostat::{Pose, Posture};
use kinetostat_model::Model;
use kinetostat_model::schema::{
    ActuatorKind, Axis, AxisName, Convention, Element, JointKind, PassiveKind, Placement, Section,
    Spring6, Stiffness,
};
use kinetostat_testing::{LargestEntry, Worst, largest};
use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, Unit, UnitQuaternion, Vector3};

use super::msa::{BASE, Structure};

/// A place on a node.
#[derive(Clone, Copy)]
struct Frame {
    node: usize,
    pose: Pose,
}

/// A joint of one motion that others may follow: its slide or turn, and its value.
struct Joint {
    row: Option<Vec<(usize, f64)>>,
    value: f64,
}

/// A machine in a posture.
pub struct PostureGraph {
    pub structure: Structure,
    /// Node of the tool.
    pub tool: usize,
    /// Where the joints lead minus where the platforms are: the worst limb, m and rad.
    pub closure_residual: f64,
}

/// The machine in a posture, from its file and the values of its joints.
pub fn structure(model: &Model, posture: &Posture) -> PostureGraph {
    let mechanism = &model.mechanism;
    let mut s = Structure::new();
    let mut nodes = vec![BASE];
    let mut worst = Worst::new();
    for place in &posture.platforms()[1..] {
        nodes.push(s.node(place.translation.vector));
    }
    for (i, written) in model.document.limb.iter().enumerate() {
        let limb = &mechanism.limbs()[i];
        let chain = &limb.nominal;
        let joints = &posture.limbs()[i];
        let coordinates = chain.coordinates().iter().zip(&joints.coordinates);
        let commands = chain.actuators().iter().zip(&joints.commands);
        let mut reader = Reader {
            model,
            s: &mut s,
            limb: i,
            coordinates: coordinates.map(|(c, v)| (c.name.as_str(), *v)).collect(),
            commands: commands.map(|(a, v)| (a.name.as_str(), *v)).collect(),
            joints: BTreeMap::new(),
            at: Frame {
                node: nodes[limb.from],
                pose: posture.platforms()[limb.from],
            },
        };
        reader.offset(&written.start.as_ref().map_or(Pose::identity(), placement));
        let elements = &model.document.chain[&written.chain].elements;
        for (k, element) in elements.iter().enumerate() {
            reader.element(element, k + 1);
        }
        let end = reader.at;
        let to = posture.platforms()[limb.to];
        let tip = to * written.end.as_ref().map_or(Pose::identity(), placement);
        let closure_residual = (tip.translation.vector - end.pose.translation.vector).norm();
        let turns = (tip.rotation * end.pose.rotation.inverse()).to_rotation_matrix();
        let closure_residual = largest([
            closure_residual,
            (turns.matrix() - Matrix3::identity()).largest_entry(),
        ]);
        assert!(
            closure_residual < 1e-9,
            "{}: the limb '{}' does not close: {closure_residual:e}",
            model.name(),
            written.name
        );
        worst.add(closure_residual);
        s.joint(nodes[limb.to], end.node, &tip.translation.vector, &[], &[]);
    }
    PostureGraph {
        structure: s,
        tool: nodes[mechanism.tool()],
        closure_residual: worst.of(mechanism.limbs().len()),
    }
}

struct Reader<'a> {
    model: &'a Model,
    s: &'a mut Structure,
    limb: usize,
    coordinates: BTreeMap<&'a str, f64>,
    commands: BTreeMap<&'a str, f64>,
    joints: BTreeMap<String, Joint>,
    at: Frame,
}

impl Reader<'_> {
    fn offset(&mut self, by: &Pose) {
        self.at.pose *= by;
    }

    fn point(&self) -> Vector3<f64> {
        self.at.pose.translation.vector
    }

    /// An axis of the frame reached, base axes.
    fn world(&self, axis: &Vector3<f64>) -> Vector3<f64> {
        self.at.pose.rotation * axis
    }

    fn element(&mut self, element: &Element, number: usize) {
        let name = element
            .name()
            .map_or_else(|| format!("{} {number}", element.word()), str::to_owned);
        match element {
            Element::Rigid(e) => self.offset(&placement(&e.rigid)),
            Element::Actuator(e) => {
                let rigid = e.rigid_drive == Some(true);
                let mm = e.stiffness_n_per_mm.map(|k| k * 1e3);
                let mm_rad = e.stiffness_n_mm_per_rad.map(|k| k * 1e-3);
                let stiffness = e.stiffness_n_per_m.or(mm);
                let stiffness = stiffness.or(e.stiffness_n_m_per_rad).or(mm_rad);
                assert_eq!(rigid, stiffness.is_none());
                let drive = self.coordinates.get(name.as_str()).copied();
                let value = self.commands[name.as_str()] + drive.unwrap_or(0.0);
                let kind = match e.actuator {
                    ActuatorKind::Prismatic => JointKind::Prismatic,
                    ActuatorKind::Revolute => JointKind::Revolute,
                    ActuatorKind::Screw => {
                        let turn = self.coordinates[format!("{name}.turn").as_str()];
                        let mm = e.lead_mm_per_turn.map(|l| l * 1e-3);
                        let lead = e.lead_m_per_turn.or(mm).expect("a lead");
                        let advance = lead / std::f64::consts::TAU;
                        let travel = value + advance * turn;
                        self.screw(&axis(&e.axis), travel, turn, advance, stiffness);
                        return;
                    }
                };
                self.one(&name, kind, &axis(&e.axis), value, stiffness, rigid);
            }
            Element::Spring(e) => {
                let mm = e.stiffness_n_per_mm.map(|k| k * 1e3);
                let mm_rad = e.stiffness_n_mm_per_rad.map(|k| k * 1e-3);
                let stiffness = e.stiffness_n_per_m.or(mm);
                let stiffness = stiffness.or(e.stiffness_n_m_per_rad).or(mm_rad);
                assert!(stiffness.is_some());
                let value = self.coordinates[name.as_str()];
                self.one(&name, e.spring, &axis(&e.axis), value, stiffness, false);
            }
            Element::Passive(e) => match e.passive {
                PassiveKind::Prismatic | PassiveKind::Revolute => {
                    let kind = match e.passive {
                        PassiveKind::Prismatic => JointKind::Prismatic,
                        _ => JointKind::Revolute,
                    };
                    let along = axis(e.axis.as_ref().expect("axis"));
                    let value = self.coordinates[name.as_str()];
                    self.one(&name, kind, &along, value, None, false);
                }
                PassiveKind::Universal => {
                    let axes = e.axes.as_ref().expect("axes");
                    self.ball(&name, &[("1", axis(&axes[0])), ("2", axis(&axes[1]))]);
                }
                PassiveKind::Spherical => {
                    let xyz = [
                        ("x", Vector3::x()),
                        ("y", Vector3::y()),
                        ("z", Vector3::z()),
                    ];
                    self.ball(&name, &xyz);
                }
            },
            Element::Spring6(e) => {
                let matrix = match &e.spring6 {
                    Spring6::Named(n) => self.stiffness(&self.model.document.stiffness[n]),
                    Spring6::Inline(s) => self.stiffness(s),
                };
                for d in ["x", "y", "z", "rx", "ry", "rz"] {
                    let value = self.coordinates[format!("{name}.{d}").as_str()];
                    assert_eq!(value, 0.0, "{name}: at rest elsewhere");
                }
                let (from, at) = (self.at.node, self.point());
                let axes = self.at.pose.rotation.to_rotation_matrix();
                self.at.node = self.s.node(at);
                self.s.spring6([from, self.at.node], &at, &axes, &matrix);
            }
            Element::Link(e) => {
                let vector = e.vector_mm.map(|v| v.map(|x| x * 1e-3)).or(e.vector_m);
                let offset = vector.map_or_else(
                    || Vector3::x() * millimetres(e.length_mm, e.length_m),
                    Vector3::from,
                );
                assert_ne!(e.convention, Some(Convention::ConstantStrain), "{name}");
                let pieces = e.segments.unwrap_or(1);
                self.link(&name, &e.link, &offset, vector.is_some(), pieces);
            }
            Element::Parallelogram(e) => {
                let length = millimetres(e.length_mm, e.length_m);
                let width = millimetres(e.width_mm, e.width_m);
                self.parallelogram(&name, &e.parallelogram, length, width);
            }
            Element::Coupled(e) => {
                let joint = &self.joints[&e.coupled];
                let (value, row) = (e.ratio * joint.value, joint.row.clone());
                let along = axis(&e.axis);
                match row {
                    None => self.offset(&motion(e.motion, &along, value)),
                    Some(row) => {
                        let own = self.free(e.motion, &along, value);
                        self.s.follow(&own, e.ratio, &row);
                    }
                }
            }
            Element::Node(_) | Element::Body(_) => {}
        }
    }

    /// A joint of one motion behind which a new node begins; its function.
    fn free(&mut self, kind: JointKind, along: &Vector3<f64>, value: f64) -> Vec<(usize, f64)> {
        let from = self.at.node;
        let along_base = self.world(along);
        self.offset(&motion(kind, along, value));
        let at = self.point();
        let to = self.s.node(at);
        self.at.node = to;
        match kind {
            JointKind::Prismatic => {
                self.s.joint(from, to, &at, &[along_base], &[]);
                self.s.slide(from, to, &at, &along_base)
            }
            JointKind::Revolute => {
                self.s.joint(from, to, &at, &[], &[along_base]);
                self.s.twist(from, to, &along_base)
            }
        }
    }

    fn one(
        &mut self,
        name: &str,
        kind: JointKind,
        along: &Vector3<f64>,
        value: f64,
        stiffness: Option<f64>,
        rigid: bool,
    ) {
        let row = if rigid {
            self.offset(&motion(kind, along, value));
            None
        } else {
            Some(self.free(kind, along, value))
        };
        if let (Some(row), Some(k)) = (&row, stiffness) {
            self.s.spring(row.clone(), k);
        }
        self.joints.insert(name.to_owned(), Joint { row, value });
    }

    /// A nut on its screw: it slides as it turns, but for what the drive gives way; m per rad.
    fn screw(
        &mut self,
        along: &Vector3<f64>,
        travel: f64,
        turn: f64,
        advance: f64,
        stiffness: Option<f64>,
    ) {
        let (from, axis) = (self.at.node, self.world(along));
        self.offset(&motion(JointKind::Prismatic, along, travel));
        self.offset(&motion(JointKind::Revolute, along, turn));
        let at = self.point();
        let to = self.s.node(at);
        self.at.node = to;
        self.s.joint(from, to, &at, &[axis], &[axis]);
        let slide = self.s.slide(from, to, &at, &axis);
        let twist = self.s.twist(from, to, &axis);
        match stiffness {
            None => self.s.follow(&slide, advance, &twist),
            Some(k) => {
                let mut deflected = slide;
                deflected.extend(twist.into_iter().map(|(i, x)| (i, -advance * x)));
                self.s.spring(deflected, k);
            }
        }
    }

    /// Turns about axes through one point, each in the frame that those before it reach.
    fn ball(&mut self, name: &str, axes: &[(&str, Vector3<f64>)]) {
        let from = self.at.node;
        let mut free = Vec::new();
        for (ending, along) in axes {
            free.push(self.world(along));
            let value = self.coordinates[format!("{name}.{ending}").as_str()];
            self.offset(&motion(JointKind::Revolute, along, value));
        }
        let at = self.point();
        self.at.node = self.s.node(at);
        self.s.joint(from, self.at.node, &at, &[], &free);
    }

    fn link(&mut self, name: &str, what: &str, offset: &Vector3<f64>, slanted: bool, pieces: u32) {
        let length = offset.norm() / f64::from(pieces);
        let turn = match slanted {
            true => frame_along(offset),
            false => Rotation3::identity(),
        };
        let axes = self.at.pose.rotation.to_rotation_matrix();
        for piece in 1..=pieces {
            let own = match pieces {
                1 => name.to_owned(),
                _ => format!("{name}.{piece}"),
            };
            let (k, axes) = match self.rigidities(what) {
                Some(rigidities) => (beam(&rigidities, length), axes * turn),
                None => {
                    let matrix = self.far_end(what, &own);
                    let offset = offset / f64::from(pieces);
                    match self.model.document.stiffness.contains_key(what) {
                        // In the axes of the frame.
                        true => (with_near_end(&matrix, &offset), axes),
                        false => (
                            with_near_end(&matrix, &(Vector3::x() * length)),
                            axes * turn,
                        ),
                    }
                }
            };
            let (from, near) = (self.at.node, self.point());
            self.offset(&Pose::from_parts(
                (offset / f64::from(pieces)).into(),
                UnitQuaternion::identity(),
            ));
            let far = self.point();
            self.at.node = self.s.node(far);
            self.s.beam([from, self.at.node], [near, far], &axes, k);
        }
    }

    /// Two bars between pivots about y, side by side along z.
    fn parallelogram(&mut self, name: &str, what: &str, length: f64, width: f64) {
        let q = self.coordinates[name];
        let near = self.at;
        let pivot = self.world(&Vector3::y());
        let bars = near.pose * motion(JointKind::Revolute, &Vector3::y(), q);
        let along = bars.rotation * (Vector3::x() * length);
        self.at.pose.translation.vector += along;
        let to = self.s.node(self.point());
        self.at.node = to;
        let k = match self.rigidities(what) {
            Some(rigidities) => beam(&rigidities, length),
            None => {
                let matrix = self.stiffness(&self.model.document.stiffness[what]);
                with_near_end(&matrix, &(Vector3::x() * length))
            }
        };
        let axes = bars.rotation.to_rotation_matrix();
        for side in [0.5 * width, -0.5 * width] {
            let foot = (near.pose * nalgebra::Point3::new(0.0, 0.0, side)).coords;
            let head = foot + along;
            let ends = [self.s.node(foot), self.s.node(head)];
            self.s.joint(near.node, ends[0], &foot, &[], &[pivot]);
            self.s.beam(ends, [foot, head], &axes, k.clone());
            self.s.joint(ends[1], to, &head, &[], &[pivot]);
        }
    }

    /// E A, G J, E I_y, E I_z of a plain section; `None` for what is read elsewhere.
    fn rigidities(&self, name: &str) -> Option<[f64; 4]> {
        let s = self.model.document.section.get(name)?;
        if s.tip.is_some() || s.shear.is_some() {
            return None;
        }
        if let Some(r) = &s.rigidities {
            let square = |mm: Option<f64>, m: Option<f64>| mm.map(|x| x * 1e-6).or(m);
            return Some([
                r.axial_n?,
                square(r.torsion_n_mm2, r.torsion_n_m2)?,
                square(r.bending_y_n_mm2, r.bending_y_n_m2)?,
                square(r.bending_z_n_mm2, r.bending_z_n_m2)?,
            ]);
        }
        let [e, g] = moduli(s)?;
        let (outer, inner) = match (&s.tube, &s.round) {
            (Some(t), _) => (
                millimetres(t.outer_diameter_mm, t.outer_diameter_m),
                millimetres(t.inner_diameter_mm, t.inner_diameter_m),
            ),
            (_, Some(r)) => (millimetres(r.diameter_mm, r.diameter_m), 0.0),
            _ => return None,
        };
        let (a, b) = (0.5 * outer, 0.5 * inner);
        let pi = std::f64::consts::PI;
        let bending = e * pi * (a.powi(4) - b.powi(4)) / 4.0;
        let torsion = g * pi * (a.powi(4) - b.powi(4)) / 2.0;
        Some([e * pi * (a * a - b * b), torsion, bending, bending])
    }

    /// The stiffness of a link's far end as a number of the file, or (other shapes than round ones,
    /// which are tested where they are made) as the model holds it.
    fn far_end(&self, what: &str, spring: &str) -> Matrix6<f64> {
        if let Some(stiffness) = self.model.document.stiffness.get(what) {
            return self.stiffness(stiffness);
        }
        let chain = &self.model.mechanism.limbs()[self.limb].nominal;
        let block = chain.springs().iter().find(|b| b.name == spring);
        let block = block.unwrap_or_else(|| panic!("no spring '{spring}'"));
        let k = block.stiffness_at(&chain.home_coordinates());
        let along = block.segment.as_ref().map(|s| s.along);
        let turn = match along {
            Some(v) if (v - Vector3::x()).norm() > 1e-12 => frame_along(&v),
            _ => Rotation3::identity(),
        };
        turned(&turn.inverse(), &Matrix6::from_fn(|i, j| k[(i, j)]))
    }

    fn stiffness(&self, s: &Stiffness) -> Matrix6<f64> {
        let mm = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => 1e3,
            (false, false) => 1e-3,
            _ => 1.0,
        };
        let diagonal = |d: [f64; 6]| Matrix6::from_diagonal(&d.into());
        let own = if let Some(m) = s.matrix_n_m_rad {
            Matrix6::from_fn(|i, j| m[i][j])
        } else if let Some(m) = s.matrix_n_mm_rad {
            Matrix6::from_fn(|i, j| m[i][j] * mm(i, j))
        } else if let Some(d) = s.diagonal_n_m_rad {
            diagonal(d)
        } else if let Some(d) = s.diagonal_n_mm_rad {
            diagonal(d).map_with_location(|i, j, x| x * mm(i, j))
        } else {
            let section = s.section.as_ref().expect("a section");
            let rigidities = self.rigidities(section).expect("a plain section");
            let k = beam(&rigidities, millimetres(s.length_mm, s.length_m));
            Matrix6::from_fn(|i, j| k[(6 + i, 6 + j)])
        };
        match &s.along {
            Some(along) => turned(&frame_along(&axis(along)), &own),
            None => own,
        }
    }
}

/// Young's and shear modulus, Pa.
fn moduli(s: &Section) -> Option<[f64; 2]> {
    if let Some(name) = &s.material {
        let m = kinetostat_links::material(name)?;
        return Some([m.youngs_modulus, m.shear_modulus()]);
    }
    let pa = |gpa: Option<f64>, mpa: Option<f64>, pa: Option<f64>| {
        gpa.map(|x| x * 1e9).or(mpa.map(|x| x * 1e6)).or(pa)
    };
    let e = pa(
        s.youngs_modulus_gpa,
        s.youngs_modulus_mpa,
        s.youngs_modulus_pa,
    )?;
    let g = pa(s.shear_modulus_gpa, s.shear_modulus_mpa, s.shear_modulus_pa);
    Some([e, g.or(s.poissons_ratio.map(|nu| 0.5 * e / (1.0 + nu)))?])
}

/// The textbook's beam between two nodes, axes of the beam, x along it.
fn beam(rigidities: &[f64; 4], l: f64) -> DMatrix<f64> {
    let [axial, torsion, about_y, about_z] = *rigidities;
    let mut k = DMatrix::zeros(12, 12);
    let mut set = |i: usize, j: usize, x: f64| {
        k[(i, j)] = x;
        k[(j, i)] = x;
    };
    for (i, x) in [(0, axial / l), (3, torsion / l)] {
        set(i, i, x);
        set(6 + i, 6 + i, x);
        set(i, 6 + i, -x);
    }
    // Deflection, slope, and the sign of the slope for a positive rotation.
    for (v, r, sign, ei) in [(1, 5, 1.0, about_z), (2, 4, -1.0, about_y)] {
        let (a, b, c) = (
            12.0 * ei / l.powi(3),
            sign * 6.0 * ei / l.powi(2),
            2.0 * ei / l,
        );
        set(v, v, a);
        set(6 + v, 6 + v, a);
        set(v, 6 + v, -a);
        set(v, r, b);
        set(v, 6 + r, b);
        set(6 + v, r, -b);
        set(6 + v, 6 + r, -b);
        set(r, r, 2.0 * c);
        set(6 + r, 6 + r, 2.0 * c);
        set(r, 6 + r, c);
    }
    k
}

/// Element of two nodes from the stiffness of its far end with the near end held.
fn with_near_end(far: &Matrix6<f64>, offset: &Vector3<f64>) -> DMatrix<f64> {
    let mut carry = Matrix6::identity();
    carry
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&-offset.cross_matrix());
    let mut k = DMatrix::zeros(12, 12);
    k.view_mut((6, 6), (6, 6)).copy_from(far);
    k.view_mut((6, 0), (6, 6)).copy_from(&-(far * carry));
    k.view_mut((0, 6), (6, 6))
        .copy_from(&-(carry.transpose() * far));
    k.view_mut((0, 0), (6, 6))
        .copy_from(&(carry.transpose() * far * carry));
    k
}

fn turned(turn: &Rotation3<f64>, k: &Matrix6<f64>) -> Matrix6<f64> {
    let mut big = Matrix6::zeros();
    big.fixed_view_mut::<3, 3>(0, 0).copy_from(turn.matrix());
    big.fixed_view_mut::<3, 3>(3, 3).copy_from(turn.matrix());
    big * k * big.transpose()
}

/// x along `v`; y horizontal, or y of the frame across x where x is nearly upright.
fn frame_along(v: &Vector3<f64>) -> Rotation3<f64> {
    let x = v.normalize();
    let helper = if x.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::y()
    };
    let y = helper.cross(&x).normalize();
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]))
}

fn motion(kind: JointKind, along: &Vector3<f64>, value: f64) -> Pose {
    match kind {
        JointKind::Prismatic => {
            Pose::from_parts((along * value).into(), UnitQuaternion::identity())
        }
        JointKind::Revolute => Pose::from_parts(
            Vector3::zeros().into(),
            UnitQuaternion::from_axis_angle(&Unit::new_normalize(*along), value),
        ),
    }
}

fn axis(axis: &Axis) -> Vector3<f64> {
    match axis {
        Axis::Named(AxisName::X) => Vector3::x(),
        Axis::Named(AxisName::Y) => Vector3::y(),
        Axis::Named(AxisName::Z) => Vector3::z(),
        Axis::Named(AxisName::MinusX) => -Vector3::x(),
        Axis::Named(AxisName::MinusY) => -Vector3::y(),
        Axis::Named(AxisName::MinusZ) => -Vector3::z(),
        Axis::Vector(v) => Vector3::from(*v).normalize(),
    }
}

fn millimetres(mm: Option<f64>, m: Option<f64>) -> f64 {
    mm.map(|x| x * 1e-3).or(m).expect("a length")
}

/// A pose of the file; of its many orientations those that the library uses.
fn placement(p: &Placement) -> Pose {
    let mm = |v: Option<[f64; 3]>| v.map(|v| Vector3::from(v) * 1e-3);
    let at = mm(p.translation_mm)
        .or(mm(p.position_mm))
        .or(p.translation_m.or(p.position_m).map(Vector3::from))
        .unwrap_or_default();
    let about = |v: Vector3<f64>, by: f64| UnitQuaternion::from_scaled_axis(v * by);
    let xyz = |[a, b, c]: [f64; 3]| {
        about(Vector3::x(), a) * about(Vector3::y(), b) * about(Vector3::z(), c)
    };
    let zyx = |[a, b, c]: [f64; 3]| {
        about(Vector3::z(), c) * about(Vector3::y(), b) * about(Vector3::x(), a)
    };
    let deg = |v: [f64; 3]| v.map(f64::to_radians);
    let turn = if let Some(v) = p.rotation_vector_deg.map(deg).or(p.rotation_vector_rad) {
        UnitQuaternion::from_scaled_axis(Vector3::from(v))
    } else if let Some(v) = p.rotation_intrinsic_xyz_deg {
        xyz(deg(v))
    } else if let Some(v) = p.roll_pitch_yaw_urdf_deg.map(deg) {
        zyx(v)
    } else if let Some(v) = p.roll_pitch_yaw_urdf_rad {
        zyx(v)
    } else if let Some(x) = &p.x_axis {
        let x = axis(x);
        let frame = match &p.y_axis {
            None => frame_along(&x),
            Some(y) => {
                let z = x.cross(&axis(y)).normalize();
                let columns = Matrix3::from_columns(&[x, z.cross(&x), z]);
                Rotation3::from_matrix_unchecked(columns)
            }
        };
        UnitQuaternion::from_rotation_matrix(&frame)
    } else {
        let others = [p.quaternion_wxyz, p.quaternion_xyzw];
        let angles = [p.a_b_c_kuka_deg, p.w_p_r_fanuc_deg];
        assert!(
            others == [None, None] && angles == [None, None],
            "an orientation that this test does not read"
        );
        UnitQuaternion::identity()
    };
    Pose::from_parts(at.into(), turn)
}
