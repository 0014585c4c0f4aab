//! All numbers of a document with their paths.

use crate::parameters::unit::{ParameterKind, unit};
use crate::parameters::walk::{Numbers, Visit, numbers, step};
use crate::schema::{
    Anchor, Axis, ConstantTensionLoad, ControllerAxisTable, ControllerCoupling, ControllerTable,
    CounterweightLoad, Deviation, Document, GasSpringLoad, LoadTable, MechanismTable, Placement,
    PlatformLoadTable, PlatformPoint, PlatformTable, PlatformWrench, RotaryAxisTable, SpringLoad,
    Workspace, WrenchLoad,
};

/// A number of a model file, by a name that people can type.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Path of the number: `chain.arm.joint 2.stiffness_n_m_per_rad`, `section.tube.tube.outer_diameter_mm`.
    pub path: String,
    /// Value in the unit of the file; 1 for a factor (`...scale`), which no file contains.
    pub value: f64,
    /// Usual notation of the unit (`N/mm`); empty for a number without unit.
    pub unit: &'static str,
    /// Kind of the quantity.
    pub kind: ParameterKind,
    /// The SI unit in one of its unit: `value * in_si` is in SI (m, rad, N, kg).
    pub in_si: f64,
}

/// All numbers in the order of the walk.
pub(crate) fn list(document: &mut Document) -> Vec<Parameter> {
    let mut lister = Lister::default();
    walk(document, &mut lister);
    lister.found
}

#[derive(Default)]
struct Lister {
    steps: Vec<String>,
    found: Vec<Parameter>,
}

impl Visit for Lister {
    fn enter(&mut self, step: &str) {
        self.steps.push(step.to_owned());
    }

    fn leave(&mut self) {
        self.steps.pop();
    }

    fn number(&mut self, value: &mut f64, _: bool) {
        let (kind, unit, in_si) = of_steps(&self.steps);
        self.found.push(Parameter {
            path: self.steps.join("."),
            value: *value,
            unit,
            kind,
            in_si,
        });
    }
}

/// Kind and unit of a number from the last steps of its path: a key, or a key and components.
fn of_steps(steps: &[String]) -> (ParameterKind, &'static str, f64) {
    let last = |back: usize| steps.len().checked_sub(back).and_then(|i| steps.get(i));
    let (one, two, three) = (last(1), last(2), last(3));
    let text = |s: Option<&String>| s.map(String::as_str).unwrap_or_default().to_owned();
    let component = |s: &str| !s.contains('_') && s.len() <= 7;
    let known = |key: &str| unit(key, None, None).0 != ParameterKind::Direction;
    let (one, two, three) = (text(one), text(two), text(three));
    // A number under its key; in a list; in a matrix.
    if known(&one) {
        return unit(&one, None, None);
    }
    if component(&one) && component(&two) && is_matrix(&three) {
        return unit(&three, Some(&two), Some(&one));
    }
    unit(&two, Some(&one), None)
}

fn is_matrix(key: &str) -> bool {
    key.starts_with("matrix_") || key == "inertia_kg_m2"
}

/// All numbers of a document, always in the same order.
pub(crate) fn walk(document: &mut Document, visit: &mut dyn Visit) {
    let Document {
        schema: _,
        // Damping has no effect in statics, and what is uncertain none on the machine as drawn.
        damping: _,
        uncertain: _,
        correlation: _,
        mechanism,
        workspace,
        platform,
        section,
        stiffness,
        chain,
        limb,
        load,
        deviation,
        rotary_axis,
        controller,
    } = document;
    step("mechanism", mechanism, "mechanism", visit);
    step("workspace", workspace, "workspace", visit);
    for platform in platform {
        let name = platform.name.clone();
        within(["platform", &name], platform, visit);
    }
    step("section", section, "section", visit);
    step("stiffness", stiffness, "stiffness", visit);
    step("chain", chain, "chain", visit);
    for limb in limb {
        visit.enter("limb");
        visit.enter(&limb.name);
        step("start", &mut limb.start, "start", visit);
        step("end", &mut limb.end, "end", visit);
        for load in &mut limb.load {
            let name = load.name().to_owned();
            within(["load", &name], load, visit);
        }
        visit.leave();
        visit.leave();
    }
    for load in load {
        let name = load.name().to_owned();
        within(["load", &name], load, visit);
    }
    for deviation in deviation {
        visit.enter("deviation");
        let (limb, at) = (deviation.limb.clone(), deviation.at.clone());
        within([&limb, &at], deviation, visit);
        visit.leave();
    }
    for axis in rotary_axis {
        let word = axis.word.letter().to_string();
        within(["rotary_axis", &word], axis, visit);
    }
    step("controller", controller, "controller", visit);
}

fn within([outer, inner]: [&str; 2], value: &mut dyn Numbers, visit: &mut dyn Visit) {
    visit.enter(outer);
    step(inner, value, "", visit);
    visit.leave();
}

numbers! {
    MechanismTable { gravity_m_per_s2, repeatability_mm } through {}
        beside { name, description, source, assumption }
    Workspace { corner_mm, corner_m, opposite_corner_mm, opposite_corner_m } through {}
        beside { source, assumption }
    PlatformTable { home, mass_kg, centre_of_mass_mm, centre_of_mass_m, inertia_kg_m2 } through {}
        beside { name, source, assumption }
    Deviation { longer_by_mm, tilted_by_deg, about } through { moved_by }
        beside { limb, at, source, assumption }
    Placement {
        translation_mm, translation_m, position_mm, position_m, rotation_vector_deg, rotation_vector_rad,
        rotation_intrinsic_xyz_deg, roll_pitch_yaw_urdf_deg, roll_pitch_yaw_urdf_rad, a_b_c_kuka_deg,
        w_p_r_fanuc_deg, quaternion_wxyz, quaternion_xyzw, x_axis, y_axis
    } through {} beside {}
    RotaryAxisTable { axis, point_mm, point_m, limits_deg } through {}
        beside { word, carries, source, assumption }
    ControllerCoupling { ratio, ratio_mm_per_deg, ratio_deg_per_mm } through {} beside { joint }
    Anchor { position_mm, position_m } through {} beside { node }
    PlatformPoint { position_mm, position_m } through {} beside { platform }
    PlatformWrench { position_mm, position_m, force_n, moment_n_m, moment_n_mm } through {}
        beside { wrench, platform, axes, source, assumption }
    WrenchLoad { force_n, moment_n_m, moment_n_mm } through {}
        beside { wrench, node, axes, source, assumption }
    CounterweightLoad { at, mass_kg } through {} beside { counterweight, source, assumption }
}

macro_rules! between_points {
    ($($point:ty),*) => { $( numbers! {
        SpringLoad<$point> {
            from, to, stiffness_n_per_m, stiffness_n_per_mm, free_length_mm, free_length_m, preload_n
        } through {} beside { spring, source, assumption }
        GasSpringLoad<$point> { from, to, force_n, length_mm, length_m, column_mm, column_m, exponent } through {}
            beside { gas_spring, source, assumption }
        ConstantTensionLoad<$point> { from, to, tension_n } through {}
            beside { constant_tension, source, assumption }
    } )* };
}
between_points!(Anchor, PlatformPoint);

impl Numbers for Axis {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        match self {
            Self::Named(_) => {}
            Self::Vector(components) => components.walk(key, visit),
        }
    }
}

impl Numbers for LoadTable {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        match self {
            Self::Wrench(l) => l.walk(key, visit),
            Self::Spring(l) => l.walk(key, visit),
            Self::GasSpring(l) => l.walk(key, visit),
            Self::ConstantTension(l) => l.walk(key, visit),
            Self::Counterweight(l) => l.walk(key, visit),
        }
    }
}

impl Numbers for PlatformLoadTable {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        match self {
            Self::Wrench(l) => l.walk(key, visit),
            Self::Spring(l) => l.walk(key, visit),
            Self::GasSpring(l) => l.walk(key, visit),
            Self::ConstantTension(l) => l.walk(key, visit),
        }
    }
}

impl Numbers for ControllerTable {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        for axis in &mut self.axis {
            let name = axis.name.clone();
            step(&name, axis, key, visit);
        }
    }
}

impl Numbers for ControllerAxisTable {
    fn walk(&mut self, _: &'static str, visit: &mut dyn Visit) {
        let Self {
            name: _,
            joint: _,
            reversed: _,
            ratio,
            zero_offset_mm,
            zero_offset_m,
            zero_offset_deg,
            zero_offset_rad,
            unit: _,
            coupled,
        } = self;
        step("ratio", ratio, "ratio", visit);
        step("zero_offset_mm", zero_offset_mm, "zero_offset_mm", visit);
        step("zero_offset_m", zero_offset_m, "zero_offset_m", visit);
        step("zero_offset_deg", zero_offset_deg, "zero_offset_deg", visit);
        step("zero_offset_rad", zero_offset_rad, "zero_offset_rad", visit);
        for coupling in coupled {
            let joint = coupling.joint.clone();
            step(&joint, coupling, "coupled", visit);
        }
    }
}
