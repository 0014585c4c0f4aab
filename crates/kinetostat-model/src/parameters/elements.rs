//! Numbers and elasticities of the elements of a chain.

use kinetostat_links::material;

use crate::parameters::walk::{Numbers, Visit, numbers, step};
use crate::schema::{
    ActuatorElement, BodyElement, ChainTable, CoupledElement, Element, HollowBox, IBeam, Knee,
    LinkElement, ParallelogramElement, PassiveElement, Rectangle, RigidElement, Rigidities, Round,
    Section, Spring6, Spring6Element, SpringElement, Stiffness, Tip, Tube, Values,
};

/// Key of the factor on all that a section or a stiffness states.
pub(crate) const SCALE: &str = "scale";

numbers! {
    Tube { outer_diameter_mm, outer_diameter_m, inner_diameter_mm, inner_diameter_m } through {} beside {}
    Round { diameter_mm, diameter_m } through {} beside {}
    Rectangle { width_mm, width_m, height_mm, height_m } through {} beside {}
    IBeam { width_mm, height_mm, flange_mm, web_mm } through {} beside {}
    HollowBox { width_mm, height_mm, wall_mm, side_wall_mm, top_wall_mm } through {} beside {}
    Tip { tube, round, rectangle, i_beam, hollow_box } through {} beside {}
    Values {
        area_mm2, area_m2, second_moment_y_mm4, second_moment_y_m4, second_moment_z_mm4, second_moment_z_m4,
        torsion_constant_mm4, torsion_constant_m4
    } through {} beside {}
    Rigidities {
        axial_n, bending_y_n_mm2, bending_y_n_m2, bending_z_n_mm2, bending_z_n_m2, torsion_n_mm2, torsion_n_m2
    } through {} beside {}
    RigidElement {} through { rigid } beside { name, source, assumption }
    ActuatorElement {
        axis, lead_mm_per_turn, lead_m_per_turn, stiffness_n_per_m, stiffness_n_per_mm, stiffness_n_m_per_rad,
        stiffness_n_mm_per_rad, rated_force_n, rated_torque_n_m, rest_mm, rest_m, rest_deg, rest_rad, home_mm, home_m,
        home_deg, home_rad, limits_mm, limits_m, limits_deg, limits_rad
    } through {} beside { actuator, name, rigid_drive, rotor, damping_n_s_per_m, damping_n_m_s_per_rad, source, assumption }
    PassiveElement { axis, home_mm, home_m, home_deg, home_rad, homes_deg, homes_rad } through { axes }
        beside { passive, name, damping_n_s_per_m, damping_n_m_s_per_rad, source, assumption }
    SpringElement {
        axis, stiffness_n_per_m, stiffness_n_per_mm, stiffness_n_m_per_rad, stiffness_n_mm_per_rad, knee, rest_mm,
        rest_m, rest_deg, rest_rad, home_mm, home_m, home_deg, home_rad
    } through {} beside { spring, name, damping_n_s_per_m, damping_n_m_s_per_rad, source, assumption }
    Knee {
        at_mm, at_m, at_deg, at_rad, then_n_per_m, then_n_per_mm, then_n_m_per_rad, then_n_mm_per_rad
    } through {} beside {}
    Spring6Element { rest_translation_mm, rest_translation_m, rest_rotation_deg, rest_rotation_rad }
        through { spring6 } beside { name, source, assumption }
    LinkElement { length_mm, length_m, vector_mm, vector_m, density_kg_m3, mass_kg_per_m } through {}
        beside { link, name, segments, convention, mass_model, source, assumption }
    ParallelogramElement { length_mm, length_m, width_mm, width_m, home_deg, home_rad } through {}
        beside { parallelogram, name, source, assumption }
    CoupledElement { axis, ratio } through {} beside { coupled, motion, source, assumption }
    BodyElement { mass_kg, centre_of_mass_mm, centre_of_mass_m, inertia_kg_m2 } through {}
        beside { body, source, assumption }
}

/// The two axes of a universal joint.
impl Numbers for [crate::schema::Axis; 2] {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        let [first, second] = self;
        visit.enter("axes");
        step("1", first, key, visit);
        step("2", second, key, visit);
        visit.leave();
    }
}

impl Numbers for ChainTable {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        for (i, element) in self.elements.iter_mut().enumerate() {
            // The name is taken out for the time of the visit: it is the step of the path to what is changed.
            match element.name().map(str::to_owned) {
                Some(name) => step(&name, element, key, visit),
                None => {
                    let label = format!("{} {}", element.word(), i + 1);
                    step(&label, element, key, visit);
                }
            }
        }
    }
}

impl Numbers for Element {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        match self {
            Self::Rigid(e) => e.walk(key, visit),
            Self::Actuator(e) => e.walk(key, visit),
            Self::Passive(e) => e.walk(key, visit),
            Self::Spring(e) => e.walk(key, visit),
            Self::Spring6(e) => e.walk(key, visit),
            Self::Link(e) => e.walk(key, visit),
            Self::Parallelogram(e) => e.walk(key, visit),
            Self::Coupled(e) => e.walk(key, visit),
            Self::Node(_) => {}
            Self::Body(e) => e.walk(key, visit),
        }
    }
}

impl Numbers for Spring6 {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        match self {
            Self::Named(_) => {}
            Self::Inline(stiffness) => stiffness.walk(key, visit),
        }
    }
}

impl Numbers for Section {
    fn walk(&mut self, _: &'static str, visit: &mut dyn Visit) {
        let Self {
            tube,
            round,
            rectangle,
            i_beam,
            hollow_box,
            values,
            rigidities,
            tip,
            shear: _,
            material: _,
            youngs_modulus_gpa,
            youngs_modulus_mpa,
            youngs_modulus_pa,
            shear_modulus_gpa,
            shear_modulus_mpa,
            shear_modulus_pa,
            poissons_ratio,
            source: _,
            assumption: _,
        } = self;
        let numbers: [(&'static str, &mut dyn Numbers); 15] = [
            ("tube", tube),
            ("round", round),
            ("rectangle", rectangle),
            ("i_beam", i_beam),
            ("hollow_box", hollow_box),
            ("values", values),
            ("rigidities", rigidities),
            ("tip", tip),
            ("youngs_modulus_gpa", youngs_modulus_gpa),
            ("youngs_modulus_mpa", youngs_modulus_mpa),
            ("youngs_modulus_pa", youngs_modulus_pa),
            ("shear_modulus_gpa", shear_modulus_gpa),
            ("shear_modulus_mpa", shear_modulus_mpa),
            ("shear_modulus_pa", shear_modulus_pa),
            ("poissons_ratio", poissons_ratio),
        ];
        for (key, value) in numbers {
            step(key, value, key, visit);
        }
        if let Some(factor) = factor(visit) {
            scale_section(self, factor);
        }
    }
}

/// Young's and the shear modulus, or all rigidities, times a factor. A material by name becomes its moduli.
fn scale_section(section: &mut Section, factor: f64) {
    if let Some(known) = section.material.as_deref().and_then(material) {
        section.material = None;
        section.youngs_modulus_pa = Some(known.youngs_modulus);
        section.shear_modulus_pa = Some(known.shear_modulus());
    }
    let mut numbers = vec![
        &mut section.youngs_modulus_gpa,
        &mut section.youngs_modulus_mpa,
        &mut section.youngs_modulus_pa,
        &mut section.shear_modulus_gpa,
        &mut section.shear_modulus_mpa,
        &mut section.shear_modulus_pa,
    ];
    if let Some(r) = &mut section.rigidities {
        numbers.extend([
            &mut r.axial_n,
            &mut r.bending_y_n_mm2,
            &mut r.bending_y_n_m2,
            &mut r.bending_z_n_mm2,
            &mut r.bending_z_n_m2,
            &mut r.torsion_n_mm2,
            &mut r.torsion_n_m2,
        ]);
    }
    for number in numbers.into_iter().flatten() {
        *number *= factor;
    }
}

impl Numbers for Stiffness {
    fn walk(&mut self, _: &'static str, visit: &mut dyn Visit) {
        let Self {
            matrix_n_m_rad,
            matrix_n_mm_rad,
            diagonal_n_m_rad,
            diagonal_n_mm_rad,
            section,
            length_mm,
            length_m,
            along,
            source: _,
            assumption: _,
        } = self;
        let of_section = section.is_some();
        let numbers: [(&'static str, &mut dyn Numbers); 7] = [
            ("matrix_n_m_rad", matrix_n_m_rad),
            ("matrix_n_mm_rad", matrix_n_mm_rad),
            ("diagonal_n_m_rad", diagonal_n_m_rad),
            ("diagonal_n_mm_rad", diagonal_n_mm_rad),
            ("length_mm", length_mm),
            ("length_m", length_m),
            ("along", along),
        ];
        for (key, value) in numbers {
            step(key, value, key, visit);
        }
        if !of_section && let Some(factor) = factor(visit) {
            let matrices = self
                .matrix_n_m_rad
                .iter_mut()
                .chain(&mut self.matrix_n_mm_rad);
            let diagonals = self
                .diagonal_n_m_rad
                .iter_mut()
                .chain(&mut self.diagonal_n_mm_rad);
            for number in matrices.flatten().flatten().chain(diagonals.flatten()) {
                *number *= factor;
            }
        }
    }
}

/// A factor that the document does not hold; `None` where it is 1.
fn factor(visit: &mut dyn Visit) -> Option<f64> {
    let mut factor = 1.0;
    visit.enter(SCALE);
    visit.number(&mut factor, false);
    visit.leave();
    (factor != 1.0).then_some(factor)
}
