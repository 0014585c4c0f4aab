//! The least of a URDF: its joints, and where they put the tip. Read by hand, without the importer.

use std::path::Path;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

struct Joint {
    name: String,
    parent: String,
    child: String,
    origin: Isometry3<f64>,
    axis: Vector3<f64>,
    moves: bool,
}

/// Joints of a robot.
pub struct Urdf(Vec<Joint>);

/// A file of ../shared/data/urdf; says SKIPPED and gives none where that is not there.
#[allow(clippy::print_stdout, reason = "a test that does nothing says so")]
pub fn open(name: &str) -> Option<Urdf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(3)?;
    let path = root
        .join("shared/data/urdf")
        .join(name)
        .with_extension("urdf");
    match std::fs::read_to_string(&path) {
        Ok(text) => Some(Urdf(joints(&text))),
        Err(_) => {
            println!("SKIPPED: no shared/data/urdf/{name}.urdf");
            None
        }
    }
}

fn joints(text: &str) -> Vec<Joint> {
    let mut list = Vec::new();
    for part in text.split("<joint ").skip(1) {
        let body = part.split("</joint>").next().unwrap_or(part);
        let (Some(parent), Some(child)) = (tag(body, "parent"), tag(body, "child")) else {
            continue; // of a transmission
        };
        let numbers = |text: Option<&str>| -> Vector3<f64> {
            let mut words = text.unwrap_or("0 0 0").split_whitespace();
            Vector3::from_fn(|_, _| words.next().and_then(|w| w.parse().ok()).expect("a number"))
        };
        let origin = tag(body, "origin").unwrap_or("");
        let rpy = numbers(attribute(origin, "rpy"));
        let axis = tag(body, "axis").and_then(|t| attribute(t, "xyz"));
        list.push(Joint {
            name: attribute(part, "name").expect("a name").into(),
            parent: attribute(parent, "link").expect("a link").into(),
            child: attribute(child, "link").expect("a link").into(),
            origin: Isometry3::from_parts(
                Translation3::from(numbers(attribute(origin, "xyz"))),
                UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z),
            ),
            axis: numbers(axis.or(Some("1 0 0"))),
            moves: attribute(part, "type") != Some("fixed"),
        });
    }
    list
}

fn tag<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let from = text.find(&format!("<{name} "))?;
    text[from..].split('>').next()
}

fn attribute<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let from = text.find(&format!("{name}=\""))? + name.len() + 2;
    text[from..].split('"').next()
}

impl Urdf {
    /// Moves the joint `name` along its parent, m.
    pub fn shift(&mut self, name: &str, by: Vector3<f64>) {
        let joint = self.0.iter_mut().find(|j| j.name == name).expect("a joint");
        joint.origin.translation.vector += by;
    }

    /// `base_link` from `tool0` with the moving joints on the way at `values`, rad, base first.
    pub fn tool(&self, values: &[f64]) -> Isometry3<f64> {
        let mut path = Vec::new();
        let mut at = "tool0";
        while at != "base_link" {
            let joint = self.0.iter().find(|j| j.child == at).expect("a way");
            path.push(joint);
            at = &joint.parent;
        }
        let mut values = values.iter();
        path.iter()
            .rev()
            .fold(Isometry3::identity(), |pose, joint| {
                let turn = match joint.moves {
                    true => joint.axis * *values.next().expect("a value"),
                    false => Vector3::zeros(),
                };
                pose * joint.origin * UnitQuaternion::from_scaled_axis(turn)
            })
    }
}
