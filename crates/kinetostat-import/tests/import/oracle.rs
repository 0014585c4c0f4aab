//! Kinematics and gravity torques straight from the XML, by 4 x 4 matrices and screw axes; shares
//! nothing with the import but the parser of XML.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Matrix4, Vector3};
use roxmltree::{Document, Node};

/// A joint of the file.
struct Joint {
    name: String,
    parent: String,
    child: String,
    origin: Matrix4<f64>,
    axis: Vector3<f64>,
    /// 'r', 'p' or 'f'.
    kind: char,
    mimic: Option<(String, f64, f64)>,
}

/// The robot of a file.
pub struct Oracle {
    joints: Vec<Joint>,
    /// Mass and centre of mass.
    masses: BTreeMap<String, (f64, Vector3<f64>)>,
    root: String,
}

fn numbers(text: Option<&str>, default: [f64; 3]) -> Vector3<f64> {
    let found: Option<Vec<f64>> =
        text.map(|t| t.split_whitespace().map(|w| w.parse().unwrap()).collect());
    match found {
        Some(v) => Vector3::new(v[0], v[1], v[2]),
        None => default.into(),
    }
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|n| n.has_tag_name(tag))
}

/// Rotation by Rodrigues' formula.
fn turn(axis: &Vector3<f64>, angle: f64) -> Matrix4<f64> {
    let k = Matrix3::new(
        0.0, -axis.z, axis.y, axis.z, 0.0, -axis.x, -axis.y, axis.x, 0.0,
    );
    let r = Matrix3::identity() + k * angle.sin() + k * k * (1.0 - angle.cos());
    r.to_homogeneous()
}

fn origin(node: Option<Node<'_, '_>>) -> Matrix4<f64> {
    let xyz = numbers(node.and_then(|n| n.attribute("xyz")), [0.0; 3]);
    let rpy = numbers(node.and_then(|n| n.attribute("rpy")), [0.0; 3]);
    Matrix4::new_translation(&xyz)
        * turn(&Vector3::z(), rpy.z)
        * turn(&Vector3::y(), rpy.y)
        * turn(&Vector3::x(), rpy.x)
}

impl Oracle {
    pub fn new(urdf: &str) -> Self {
        let document = Document::parse(urdf).unwrap();
        let robot = document.root_element();
        let mut joints = Vec::new();
        for node in robot.children().filter(|n| n.has_tag_name("joint")) {
            let link = |tag| {
                child(node, tag)
                    .unwrap()
                    .attribute("link")
                    .unwrap()
                    .to_owned()
            };
            let axis = child(node, "axis").and_then(|n| n.attribute("xyz"));
            let kind = match node.attribute("type").unwrap() {
                "revolute" | "continuous" => 'r',
                "prismatic" => 'p',
                _ => 'f',
            };
            let axis = numbers(axis, [1.0, 0.0, 0.0]);
            let mimic = child(node, "mimic").map(|m| {
                let number =
                    |key, default| m.attribute(key).map_or(default, |t| t.parse().unwrap());
                (
                    m.attribute("joint").unwrap().to_owned(),
                    number("multiplier", 1.0),
                    number("offset", 0.0),
                )
            });
            joints.push(Joint {
                name: node.attribute("name").unwrap().into(),
                parent: link("parent"),
                child: link("child"),
                origin: origin(child(node, "origin")),
                axis: if kind == 'f' { axis } else { axis.normalize() },
                kind,
                mimic,
            });
        }
        let mut masses = BTreeMap::new();
        let mut root = String::new();
        for node in robot.children().filter(|n| n.has_tag_name("link")) {
            let name = node.attribute("name").unwrap();
            if !joints.iter().any(|j| j.child == name) {
                root = name.into();
            }
            if let Some(inertial) = child(node, "inertial") {
                let mass = child(inertial, "mass").unwrap().attribute("value").unwrap();
                let centre = origin(child(inertial, "origin"))
                    .fixed_view::<3, 1>(0, 3)
                    .into_owned();
                masses.insert(name.to_owned(), (mass.parse().unwrap(), centre));
            }
        }
        Self {
            joints,
            masses,
            root,
        }
    }

    /// Displacement of a joint per unit of every independent joint, and its value.
    fn value(&self, joint: &Joint, values: &BTreeMap<&str, f64>) -> (String, f64, f64) {
        match &joint.mimic {
            None => (
                joint.name.clone(),
                1.0,
                values.get(joint.name.as_str()).copied().unwrap_or(0.0),
            ),
            Some((source, multiplier, offset)) => {
                let source = self.joints.iter().find(|j| j.name == *source).unwrap();
                let (name, ratio, value) = self.value(source, values);
                (name, ratio * multiplier, multiplier * value + offset)
            }
        }
    }

    /// Frames of all links in the root.
    fn frames(&self, values: &BTreeMap<&str, f64>) -> BTreeMap<&str, Matrix4<f64>> {
        let mut frames = BTreeMap::from([(self.root.as_str(), Matrix4::identity())]);
        while frames.len() <= self.joints.len() {
            for joint in &self.joints {
                let Some(parent) = frames.get(joint.parent.as_str()).copied() else {
                    continue;
                };
                let (_, _, q) = self.value(joint, values);
                let motion = match joint.kind {
                    'r' => turn(&joint.axis, q),
                    'p' => Matrix4::new_translation(&(joint.axis * q)),
                    _ => Matrix4::identity(),
                };
                frames.insert(&joint.child, parent * joint.origin * motion);
            }
        }
        frames
    }

    /// Base from tip.
    pub fn pose(&self, base: &str, tip: &str, values: &BTreeMap<&str, f64>) -> Matrix4<f64> {
        let frames = self.frames(values);
        frames[base].try_inverse().unwrap() * frames[tip]
    }

    /// Force or torque that holds every one of `joints` against gravity (9.81 m/s^2 against z of the
    /// root), N or N m: minus the work of the weights per motion of the joint.
    pub fn holding(&self, joints: &[&str], values: &BTreeMap<&str, f64>) -> Vec<f64> {
        let frames = self.frames(values);
        let mut torques = vec![0.0; joints.len()];
        for (link, (mass, centre)) in &self.masses {
            let centre = frames[link.as_str()]
                .transform_point(&(*centre).into())
                .coords;
            // Up to the root: every joint on the way moves the mass.
            let mut at = link.clone();
            while let Some(joint) = self.joints.iter().find(|j| j.child == at) {
                let (name, ratio, _) = self.value(joint, values);
                if let Some(i) = joints.iter().position(|j| *j == name)
                    && joint.kind != 'f'
                {
                    let frame = frames[joint.parent.as_str()] * joint.origin;
                    let axis = frame.transform_vector(&joint.axis);
                    let point: Vector3<f64> = frame.fixed_view::<3, 1>(0, 3).into_owned();
                    let velocity = match joint.kind {
                        'r' => axis.cross(&(centre - point)),
                        _ => axis,
                    };
                    torques[i] += ratio * mass * 9.81 * velocity.z;
                }
                at.clone_from(&joint.parent);
            }
        }
        torques
    }
}
