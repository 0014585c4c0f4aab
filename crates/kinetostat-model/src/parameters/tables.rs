//! Numbers in the tables of a document.

use crate::parameters::walk::{Numbers, Visit, numbers, step};
use crate::schema::{
    Anchor, Axis, ConstantTensionLoad, ControllerAxisTable, ControllerCoupling, ControllerTable,
    CounterweightLoad, Deviation, GasSpringLoad, LoadTable, MechanismTable, Placement,
    PlatformLoadTable, PlatformPoint, PlatformTable, PlatformWrench, RotaryAxisTable, SpringLoad,
    Workspace, WrenchLoad,
};

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
