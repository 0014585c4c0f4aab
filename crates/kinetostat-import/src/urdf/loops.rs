//! Options of the import and the loop file: what a URDF cannot say about closed loops, with the same content as the proposed
//! `<constraint>` element.

use std::collections::BTreeMap;

use kinetostat::MotionKind;
use kinetostat_model::schema::{AxisName, Section};
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::log::{At, Log};
use crate::stiffness::JointStiffness;
use crate::urdf::read::closure;
use crate::urdf::robot::{Constraint, Origin, Robot, Side};

/// A loop file by its name and text.
///
/// ```toml
/// schema = 1
/// passive = ["elbow", "bar_foot"]   # joints of the URDF that nothing drives
/// home_rad = { shoulder = 0.3 }     # joints that do not stand at zero at home; home_m for sliding ones
///
/// [[constraint]]                    # the joint at which the loop was cut
/// name = "bar_head"
/// type = "revolute"                 # revolute, prismatic, universal or spherical
/// parent = { link = "bar", origin_m = [1.2, 0, 0], axis = [0, 1, 0] }
/// child = { link = "forearm", origin_m = [-0.3, 0, 0], roll_pitch_yaw_urdf_rad = [0, 0, 0] }
/// ```
///
/// Revolute and prismatic joints have the axis of `parent`, in the axes of both origins; a
/// universal joint turns about the axis of `parent`, then about that of `child` (y if not given); a
/// spherical one needs no axis.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoopFile {
    /// Name for messages.
    pub file: String,
    /// TOML.
    pub text: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    schema: Spanned<u32>,
    #[serde(default)]
    passive: Vec<Spanned<String>>,
    #[serde(default)]
    home_rad: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    home_m: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    constraint: Vec<Spanned<WrittenConstraint>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenConstraint {
    name: String,
    r#type: Spanned<String>,
    parent: Spanned<WrittenSide>,
    child: Spanned<WrittenSide>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenSide {
    link: String,
    #[serde(default)]
    origin_m: [f64; 3],
    #[serde(default)]
    roll_pitch_yaw_urdf_rad: [f64; 3],
    axis: Option<[f64; 3]>,
}

/// Additions of a loop file to the robot.
#[derive(Default)]
pub(crate) struct Loops {
    pub(crate) passive: Vec<(At, String)>,
    /// Joint, value (rad or m), true for rad.
    pub(crate) home: Vec<(At, String, f64, bool)>,
}

/// Reads a loop file; its constraints go to the robot.
pub(crate) fn read(loops: &LoopFile, robot: &mut Robot, log: &mut Log) -> Loops {
    let file = log.file(&loops.file, &loops.text);
    let at = |span: std::ops::Range<usize>, element: String| At {
        file,
        span,
        element,
    };
    let written: Written = match kinetostat_model::exact_toml(&loops.text) {
        Ok(written) => written,
        Err(e) => {
            log.error(
                &at(e.span().unwrap_or_default(), String::new()),
                format!("this is no loop file: {}", e.message()),
                "it has schema = 1, passive = [...], home_rad = {...} and [[constraint]] tables with name, type, parent and child",
            );
            return Loops::default();
        }
    };
    if *written.schema.as_ref() != 1 {
        log.error(
            &at(written.schema.span(), "schema".into()),
            format!(
                "this is version {} of the format; version 1 is read here",
                written.schema.as_ref()
            ),
            "write schema = 1",
        );
        return Loops::default();
    }
    for constraint in written.constraint {
        let place = constraint.span();
        let c = constraint.into_inner();
        let element = format!("constraint '{}'", c.name);
        let mut side = |written: Spanned<WrittenSide>, end: &str| {
            let at = at(written.span(), format!("{element} / {end}"));
            let s = written.into_inner();
            let numbers = s
                .origin_m
                .iter()
                .chain(&s.roll_pitch_yaw_urdf_rad)
                .chain(s.axis.iter().flatten());
            if numbers.clone().any(|x| !x.is_finite()) {
                log.error(&at, "a number is not finite", "write a finite number");
                return None;
            }
            if s.axis.is_some_and(|a| a.iter().all(|x| x.abs() < 1e-9)) {
                log.error(
                    &at,
                    "the axis has no direction",
                    "write one as in axis = [0, 0, 1]",
                );
                return None;
            }
            Some(Side {
                at,
                link: s.link,
                origin: Origin {
                    xyz: s.origin_m,
                    rpy: s.roll_pitch_yaw_urdf_rad,
                },
                axis: s.axis,
            })
        };
        let (parent, child) = (side(c.parent, "parent"), side(c.child, "child"));
        let word = at(c.r#type.span(), format!("{element} / type"));
        let closure = closure(c.r#type.as_ref(), &word, log);
        if let (Some(parent), Some(child), Some(closure)) = (parent, child, closure) {
            robot.constraints.push(Constraint {
                at: at(place, element),
                name: c.name,
                closure,
                parent,
                child,
            });
        }
    }
    let mut home = Vec::new();
    for (values, turning) in [(written.home_rad, true), (written.home_m, false)] {
        for (joint, value) in values {
            let place = at(value.span(), format!("home of '{joint}'"));
            home.push((place, joint, value.into_inner(), turning));
        }
    }
    Loops {
        passive: written
            .passive
            .into_iter()
            .map(|p| (at(p.span(), "passive".into()), p.into_inner()))
            .collect(),
        home,
    }
}

/// Options of the import of a URDF.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct UrdfOptions {
    /// Link that stands; the root of the tree if not given.
    pub base: Option<String>,
    /// Link that carries the tool; needed unless only one link ends the tree.
    pub tip: Option<String>,
    /// Axis of the tip link that points out of the flange and becomes z of the tool frame; the frame of the
    /// link if not given.
    pub flange_z: Option<AxisName>,
    /// Closed loops.
    pub loops: Option<LoopFile>,
    /// Joints that nothing drives, besides those of the loop file.
    pub passive: Vec<String>,
    /// Joints that do not stand at zero at home, besides those of the loop file: whether the value
    /// is an angle (rad) or a distance (m), and the value. The kind must be the joint's. A joint
    /// whose limits leave zero out stands in the middle of them.
    pub home: BTreeMap<String, (MotionKind, f64)>,
    /// Stiffness of the drives.
    pub stiffness: JointStiffness,
    /// Section of all links: straight beams from joint to joint. Rigid if not given.
    pub section: Option<Section>,
}
