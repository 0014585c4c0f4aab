//! Options of the import of a URDF.

use std::collections::BTreeMap;

use kinetostat::MotionKind;
use kinetostat_model::schema::Section;

use crate::stiffness::JointStiffness;
use crate::urdf::loops::LoopFile;

/// Options of the import of a URDF.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct UrdfOptions {
    /// Link that stands; the root of the tree if not given.
    pub base: Option<String>,
    /// Link that carries the tool; needed unless only one link ends the tree.
    pub tip: Option<String>,
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
