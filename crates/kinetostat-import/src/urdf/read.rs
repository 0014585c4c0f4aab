//! From the XML tree to a [`Robot`]: every element and attribute that moves or bends it is read or
//! refused; what does neither is counted and skipped.

use std::collections::BTreeMap;

use kinetostat::MotionKind;
use kinetostat::number::short;
use nalgebra::Matrix3;
use roxmltree::{Document, Node};

use crate::log::{At, Log, suggestion};
use crate::urdf::robot::{
    Closure, Constraint, Inertial, Joint, JointType, Link, Mimic, Robot, Side,
};
use crate::urdf::values::{Reader, children, only};

/// Maximum number of links or joints of a robot arm.
const MOST_PARTS: usize = 1_000;

/// Elements that neither move nor bend a robot.
const SKIPPED: [&str; 15] = [
    "material",
    "transmission",
    "gazebo",
    "ros2_control",
    "visual",
    "collision",
    "dynamics",
    "safety_controller",
    "calibration",
    "contact",
    "sensor",
    "disable_collisions",
    "version",
    "author",
    "self_collision_checking",
];

/// Principal moments may be off by this share of the largest where they were rounded.
const ROUNDING: f64 = 1e-6;

/// An inertia of less than this share of the mass is none: that of a body of a micrometre, m^2.
const NO_SIZE_M2: f64 = 1e-12;

pub(crate) fn read(document: &Document<'_>, file: usize, log: &mut Log) -> Robot {
    let mut reader = Reader {
        log,
        file,
        skipped: BTreeMap::new(),
    };
    reader.robot(document.root_element())
}

impl Reader<'_> {
    fn robot(&mut self, node: Node<'_, '_>) -> Robot {
        let mut robot = Robot {
            at: self.at(node, ""),
            ..Robot::default()
        };
        let tag = node.tag_name();
        if tag.name() != "robot" {
            let help = match tag.name() {
                "sdf" => {
                    "this is SDF; name a URDF file (gz sdf does not write one; export it again)"
                }
                "mujoco" | "mujocoinclude" => "this is MJCF; name a URDF file",
                _ => "name a URDF file",
            };
            self.log.error(
                &robot.at,
                format!("the outermost element is <{}>, not <robot>", tag.name()),
                help,
            );
            return robot;
        }
        robot.name = match node.attribute("name").map(str::trim) {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => {
                self.log.notice(
                    &robot.at,
                    "the robot has no name",
                    "it is called 'robot' in the model",
                );
                "robot".into()
            }
        };
        let words = ["link", "joint", "constraint"];
        for child in node.children().filter(Node::is_element) {
            if !self.plain(child, "") {
                return robot;
            }
            match child.tag_name().name() {
                "link" => {
                    let link = self.link(child);
                    robot.links.extend(link);
                }
                "joint" => {
                    let joint = self.joint(child);
                    robot.joints.extend(joint);
                }
                "constraint" => {
                    let constraint = self.constraint(child);
                    robot.constraints.extend(constraint);
                }
                other => self.unread(child, other, "robot", &words),
            }
            if robot.links.len() > MOST_PARTS || robot.joints.len() > MOST_PARTS {
                let at = self.at(child, "");
                self.log.error(
                    &at,
                    format!("there are more than {MOST_PARTS} links or joints"),
                    "name the file of a robot, not of a scene",
                );
                return robot;
            }
        }
        if robot.links.is_empty() && !self.log.any_errors() {
            self.log.error(
                &robot.at,
                "the robot has no links",
                "a URDF has <link> and <joint> elements",
            );
        }
        if !self.skipped.is_empty() {
            let list: Vec<String> = self
                .skipped
                .iter()
                .map(|(word, count)| format!("<{word}> {count}x"))
                .collect();
            self.log.notice(
                &robot.at,
                format!(
                    "skipped, since it neither moves nor bends the robot here: {}",
                    list.join(", ")
                ),
                "nothing has to be done; files of meshes stay in the model as comments",
            );
        }
        robot
    }

    /// False for a file that was not expanded.
    fn plain(&mut self, node: Node<'_, '_>, element: &str) -> bool {
        let macros = node
            .tag_name()
            .namespace()
            .is_some_and(|uri| uri.contains("xacro"));
        if macros {
            let at = self.at(node, element);
            self.log.error(
                &at,
                "this is a xacro file: macros are not expanded here",
                self.log.expansion(self.file),
            );
        }
        !macros
    }

    /// An element without meaning here: skipped, or refused where it looks like a slip of the pen.
    fn unread(&mut self, node: Node<'_, '_>, tag: &str, element: &str, words: &[&str]) {
        if !self.plain(node, element) {
            return;
        }
        if !SKIPPED.contains(&tag) {
            let near = words
                .iter()
                .find(|w| strsim::damerau_levenshtein(w, tag) <= 2 && tag.len() > 3);
            let at = self.at(node, element);
            match near {
                Some(word) => self.log.error(
                    &at,
                    format!("the element <{tag}> is unknown"),
                    format!("did you mean <{word}>?"),
                ),
                None => self.log.notice(
                    &at,
                    format!("the element <{tag}> is not read"),
                    "nothing has to be done if it neither moves nor bends the robot",
                ),
            }
            return;
        }
        *self.skipped.entry(tag.to_owned()).or_default() += 1;
    }

    /// The name of a link, joint or constraint.
    fn name(&mut self, node: Node<'_, '_>, word: &str) -> Option<String> {
        let at = self.at_value(node, "name", "");
        let Some(name) = node.attribute("name") else {
            self.log.error(
                &at,
                format!("this {word} has no name"),
                format!("write <{word} name=\"...\">"),
            );
            return None;
        };
        let reason = if name.trim().is_empty() {
            "is empty"
        } else if name.trim() != name {
            "begins or ends with a space"
        } else if name.chars().any(char::is_control) {
            "holds a control character"
        } else if name.chars().count() > 80 {
            "is longer than 80 characters"
        } else {
            return Some(name.to_owned());
        };
        self.log.error(
            &at,
            format!("the name of this {word} {reason}"),
            "write a short name in plain text",
        );
        None
    }

    fn link(&mut self, node: Node<'_, '_>) -> Option<Link> {
        let name = self.name(node, "link")?;
        let element = format!("link '{name}'");
        let mut link = Link {
            at: self.at(node, &element),
            name,
            ..Link::default()
        };
        for child in node.children().filter(Node::is_element) {
            if !self.plain(child, &element) {
                return None;
            }
            match child.tag_name().name() {
                "inertial" if link.has_inertial => {
                    let at = self.at(child, &element);
                    self.log.error(
                        &at,
                        "there is a second <inertial>",
                        "a link has one mass; keep one of them",
                    );
                }
                "inertial" => {
                    link.has_inertial = true;
                    link.inertial = self.inertial(child, &element);
                }
                other => {
                    let meshes = child
                        .descendants()
                        .filter(|n| n.has_tag_name("mesh"))
                        .filter_map(|n| n.attribute("filename"));
                    for mesh in meshes {
                        if link.meshes.len() < 100 && !link.meshes.iter().any(|m| m == mesh) {
                            link.meshes.push(mesh.to_owned());
                        }
                    }
                    self.unread(child, other, &element, &["inertial"]);
                }
            }
        }
        Some(link)
    }

    fn inertial(&mut self, node: Node<'_, '_>, link: &str) -> Option<Inertial> {
        let element = format!("{link} / inertial");
        let at = self.at(node, &element);
        for child in node.children().filter(Node::is_element) {
            let tag = child.tag_name().name();
            if !["origin", "mass", "inertia"].contains(&tag) {
                self.unread(child, tag, &element, &["origin", "mass", "inertia"]);
            }
        }
        let origin = self.origin(node, "origin", &element);
        let Some(mass_node) = only(node, "mass") else {
            self.log.error(
                &at,
                "the mass is missing",
                "write <mass value=\"...\"/> in kg, or remove <inertial>",
            );
            return None;
        };
        self.attributes(mass_node, &["value"], &element);
        let mass = self.number(mass_node, "value", None, &element);
        if let Some(m) = mass.filter(|m| *m < 0.0) {
            let at = self.at_value(mass_node, "value", &element);
            self.log.error(
                &at,
                format!("the mass is {m} kg"),
                "a mass is not below zero; a counterweight has a mass too",
            );
            return None;
        }
        let mut inertia = Some((Matrix3::zeros(), false));
        match only(node, "inertia") {
            Some(inertia_node) => {
                let keys = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
                self.attributes(inertia_node, &keys, &element);
                let numbers: Vec<Option<f64>> = keys
                    .iter()
                    .map(|k| {
                        // Products of inertia may be left out, as in other readers.
                        let default = (k.as_bytes()[1] != k.as_bytes()[2]).then_some(0.0);
                        self.number(inertia_node, k, default, &element)
                    })
                    .collect();
                inertia = match numbers[..] {
                    [Some(xx), Some(xy), Some(xz), Some(yy), Some(yz), Some(zz)] => {
                        let m = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                        self.sound_inertia(inertia_node, mass?, &m, &element)
                    }
                    _ => None,
                };
            }
            None => self.log.notice(
                &at,
                "the inertia is missing",
                "statics does not need it; it is zero in the model",
            ),
        }
        let (inertia, left_out) = inertia?;
        Some(Inertial {
            at,
            mass: mass?,
            origin: origin?,
            inertia,
            left_out,
        })
    }

    /// The inertia for the model, and whether that of the file is left out; none where its size is refused. Statics does not use
    /// it, so that what no body can have is noticed; a model has no moments below zero, and goes without.
    fn sound_inertia(
        &mut self,
        node: Node<'_, '_>,
        mass: f64,
        m: &Matrix3<f64>,
        element: &str,
    ) -> Option<(Matrix3<f64>, bool)> {
        let at = self.at(node, element);
        let most = m.amax();
        if most > 1e12 {
            self.log.error(
                &at,
                format!("a moment of inertia is {} kg m^2", short(most)),
                "check the unit: kg m^2",
            );
            return None;
        }
        if most <= NO_SIZE_M2 * mass {
            return Some((Matrix3::zeros(), false));
        }
        // Scaled first: extreme numbers can keep the iteration busy.
        let eigenvalues = (m / most).symmetric_eigenvalues() * most;
        let mut principal: Vec<f64> = eigenvalues.iter().copied().collect();
        principal.sort_by(f64::total_cmp);
        let rounding = ROUNDING * principal[2].abs();
        let shown = || {
            let [least, middle, largest] = [0, 1, 2].map(|k| short(principal[k]));
            format!("{least}, {middle} and {largest} kg m^2")
        };
        if principal[0] < -rounding {
            self.log.notice(
                &at,
                format!("no body has this inertia: its principal moments are {}, and one is below zero", shown()),
                "statics does not use it, and the model is written without it; check its signs and the order ixx ixy ixz iyy iyz izz before the file is used for motion",
            );
            return Some((Matrix3::zeros(), true));
        }
        if principal[0] + principal[1] < principal[2] - rounding {
            self.log.notice(
                &at,
                format!(
                    "no rigid body has this inertia: its principal moments are {}, and the largest is above the sum of the others",
                    shown()
                ),
                "statics does not use it; correct it before the file is used for motion",
            );
        }
        // A moment that was rounded below zero is zero.
        Some((m - Matrix3::identity() * principal[0].min(0.0), false))
    }

    fn joint(&mut self, node: Node<'_, '_>) -> Option<Joint> {
        let name = self.name(node, "joint")?;
        let element = format!("joint '{name}'");
        let at = self.at(node, &element);
        let words = ["origin", "parent", "child", "axis", "limit", "mimic"];
        for child in node.children().filter(Node::is_element) {
            if !self.plain(child, &element) {
                return None;
            }
            let tag = child.tag_name().name();
            if !words.contains(&tag) {
                self.unread(child, tag, &element, &words);
            }
        }
        let word = node.attribute("type").map(str::trim).unwrap_or_default();
        let kind = match word {
            "fixed" => JointType::Fixed,
            "revolute" | "continuous" => JointType::Moving(MotionKind::Revolute),
            "prismatic" => JointType::Moving(MotionKind::Prismatic),
            "floating" => JointType::Several("floating"),
            "planar" => JointType::Several("planar"),
            "" => {
                self.log.error(
                    &at,
                    "the type is missing",
                    "write type=\"revolute\", \"continuous\", \"prismatic\" or \"fixed\"",
                );
                return None;
            }
            other => {
                let known = ["revolute", "continuous", "prismatic", "fixed"];
                let at = self.at_value(node, "type", &element);
                self.log.error(
                    &at,
                    format!("the type '{other}' is unknown"),
                    suggestion(other, known.into_iter()),
                );
                return None;
            }
        };
        let parent = self.end(node, "parent", &element);
        let child = self.end(node, "child", &element);
        let origin = self.origin(node, "origin", &element);
        let axis = match kind {
            JointType::Moving(_) => self.axis(node, "axis", &element),
            // Fixed joints carry axes of all kinds, zero included; nothing turns about them.
            _ => Some(None),
        };
        let (limits, limit_at) = match kind {
            JointType::Moving(motion) if word != "continuous" => {
                self.limits(node, motion, &element)?
            }
            _ => (None, None),
        };
        let mimic = match only(node, "mimic") {
            Some(m) if matches!(kind, JointType::Moving(_)) => Some(self.mimic(m, &element)?),
            _ => None,
        };
        Some(Joint {
            at,
            name,
            kind,
            word: word.to_owned(),
            origin: origin?,
            parent: parent?,
            child: child?,
            axis: axis?.unwrap_or([1.0, 0.0, 0.0]),
            limits,
            limit_at,
            mimic,
        })
    }

    /// `<parent link="..."/>` or `<child link="..."/>`.
    fn end(&mut self, node: Node<'_, '_>, tag: &str, element: &str) -> Option<(At, String)> {
        let at = self.at(node, element);
        let Some(end) = only(node, tag) else {
            self.log.error(
                &at,
                format!("<{tag}> is missing"),
                format!("write <{tag} link=\"...\"/>"),
            );
            return None;
        };
        let at = self.at_value(end, "link", &format!("{element} / {tag}"));
        if children(node, tag).count() > 1 {
            self.log.error(
                &at,
                format!("<{tag}> is written twice"),
                "a joint joins two links; a loop is closed by a <constraint> or a loop file",
            );
            return None;
        }
        match end.attribute("link").map(str::trim) {
            Some(link) if !link.is_empty() => Some((at, link.to_owned())),
            _ => {
                self.log.error(
                    &at,
                    "the link is not named",
                    format!("write <{tag} link=\"...\"/>"),
                );
                None
            }
        }
    }

    #[allow(clippy::type_complexity, reason = "limits and where they stand")]
    fn limits(
        &mut self,
        node: Node<'_, '_>,
        motion: MotionKind,
        element: &str,
    ) -> Option<(Option<(f64, f64)>, Option<At>)> {
        let at = self.at(node, element);
        let Some(limit) = only(node, "limit") else {
            self.log.notice(
                &at,
                "there is no <limit>, which this type of joint needs",
                "the joint is without limits in the model; write type=\"continuous\" if it has none",
            );
            return Some((None, None));
        };
        let element = format!("{element} / limit");
        let at = self.at(limit, &element);
        self.attributes(limit, &["lower", "upper", "effort", "velocity"], &element);
        if !limit.has_attribute("lower") && !limit.has_attribute("upper") {
            self.log.notice(
                &at,
                "'lower' and 'upper' are missing",
                "the joint is without limits in the model",
            );
            return Some((None, None));
        }
        let low = self.bound(limit, "lower", &element)?;
        let high = self.bound(limit, "upper", &element)?;
        if low.is_infinite() || high.is_infinite() {
            if low.is_finite() || high.is_finite() {
                self.log.notice(
                    &at,
                    format!("the limits {low} .. {high} end on one side only"),
                    "the joint is without limits in the model; write both",
                );
            }
            return Some((None, None));
        }
        if low > high {
            self.log.error(
                &at,
                format!("the lower limit {low} is above the upper limit {high}"),
                "exchange them",
            );
            return None;
        }
        let (most, message) = match motion {
            MotionKind::Revolute => (
                12.6,
                "limits are more than two turns away: angles of a URDF are radians; are these degrees?",
            ),
            MotionKind::Prismatic => (
                100.0,
                "limits are more than 100 m away: lengths of a URDF are metres; are these millimetres?",
            ),
        };
        if low.abs().max(high.abs()) > most {
            self.log.notice(&at, message, "check the unit");
        }
        Some((Some((low, high)), Some(at)))
    }

    fn mimic(&mut self, node: Node<'_, '_>, element: &str) -> Option<Mimic> {
        let element = format!("{element} / mimic");
        self.attributes(node, &["joint", "multiplier", "offset"], &element);
        let at = self.at(node, &element);
        let joint = match node.attribute("joint").map(str::trim) {
            Some(joint) if !joint.is_empty() => joint.to_owned(),
            _ => {
                self.log.error(
                    &at,
                    "the joint that it follows is not named",
                    "write <mimic joint=\"...\" multiplier=\"...\" offset=\"...\"/>",
                );
                return None;
            }
        };
        Some(Mimic {
            joint,
            multiplier: self.number(node, "multiplier", Some(1.0), &element)?,
            offset: self.number(node, "offset", Some(0.0), &element)?,
            at,
        })
    }

    /// The proposed `<constraint>`: the joint at which a loop was cut.
    fn constraint(&mut self, node: Node<'_, '_>) -> Option<Constraint> {
        let name = self.name(node, "constraint")?;
        let element = format!("constraint '{name}'");
        let at = self.at(node, &element);
        let words = [
            "parent",
            "parent_origin",
            "parent_axis",
            "child",
            "child_origin",
            "child_axis",
        ];
        for child in node.children().filter(Node::is_element) {
            let tag = child.tag_name().name();
            if !words.contains(&tag) {
                self.unread(child, tag, &element, &words);
            }
        }
        let mut side = |end: &str| {
            let (at, link) = self.end(node, end, &element)?;
            let origin = self.origin(node, &format!("{end}_origin"), &element)?;
            let axis = self.axis(node, &format!("{end}_axis"), &element)?;
            Some(Side {
                at,
                link,
                origin,
                axis,
            })
        };
        let (parent, child) = (side("parent"), side("child"));
        let closure = closure(
            node.attribute("type").unwrap_or_default(),
            &self.at_value(node, "type", &element),
            self.log,
        )?;
        Some(Constraint {
            at,
            name,
            closure,
            parent: parent?,
            child: child?,
        })
    }
}

/// The types of a closing joint, in a `<constraint>` as in a loop file.
pub(crate) fn closure(word: &str, at: &At, log: &mut Log) -> Option<Closure> {
    let known = [
        "revolute",
        "continuous",
        "prismatic",
        "universal",
        "spherical",
    ];
    Some(match word.trim() {
        "revolute" | "continuous" => Closure::Single(MotionKind::Revolute),
        "prismatic" => Closure::Single(MotionKind::Prismatic),
        "universal" => Closure::Universal,
        "spherical" | "ball" => Closure::Spherical,
        "fixed" => {
            log.error(
                at,
                "a loop cannot be closed by a fixed joint",
                "cut it at a joint that moves",
            );
            return None;
        }
        other => {
            log.error(
                at,
                format!("the type '{other}' of this closing joint is unknown"),
                suggestion(other, known.into_iter()),
            );
            return None;
        }
    })
}
