//! Closed loops: by `<constraint>` elements and by loop files. The heavy arm has the topology of an
//! IRB 8700: the lower arm is pushed by a linear actuator, the upper arm is led by a bar from a crank
//! beside the shoulder, and the crank carries a counterweight. Lengths and masses are made up.

use kinetostat::{MechanismEquilibrium, MotionKind, PostureRequest, Wrench, machine::LimbPosture};
use kinetostat_import::{Imported, JointStiffness, LoopFile, UrdfOptions, import_urdf};
use kinetostat_model::schema::{Section, Tube};
use kinetostat_testing::largest_size;

use nalgebra::Vector3;

use crate::{figure_at_most, import, notices};

fn link(name: &str, centre: [f64; 3], mass: f64) -> String {
    let [x, y, z] = centre;
    format!(
        "<link name='{name}'><inertial><origin xyz='{x} {y} {z}'/><mass value='{mass}'/><inertia ixx='1' ixy='0' ixz='0' iyy='1.2' iyz='0' izz='1.1'/></inertial></link>\n"
    )
}

fn joint(name: &str, kind: &str, ends: [&str; 2], xyz: [f64; 3], axis: &str) -> String {
    let [x, y, z] = xyz;
    let [parent, child] = ends;
    format!(
        "<joint name='{name}' type='{kind}'><origin xyz='{x} {y} {z}'/><parent link='{parent}'/><child link='{child}'/><axis xyz='{axis}'/><limit lower='-2' upper='2' effort='1' velocity='1'/></joint>\n"
    )
}

/// The arm with all loops cut. At zero the lower arm points up, the upper arm ahead; bar and lower arm
/// make a parallelogram with the crank.
fn heavy() -> String {
    let mut text = String::from("<robot name='heavy'>\n<link name='base'/>\n");
    text += &link("turret", [0.1, 0.0, 0.3], 900.0);
    text += &link("lower_arm", [0.05, 0.02, 0.6], 500.0);
    text += &link("upper_arm", [0.5, 0.0, 0.1], 450.0);
    text += &link("wrist", [0.1, 0.0, 0.0], 90.0);
    text += &link("cylinder", [0.3, 0.0, 0.02], 80.0);
    text += &link("rod", [0.2, 0.0, 0.0], 30.0);
    // The counterweight sits behind the crank's axis.
    text += &link("crank", [-0.9, 0.0, 0.05], 1200.0);
    text += &link("bar", [0.0, 0.0, 0.6], 60.0);
    text += "<link name='flange'/>\n";
    text += &joint(
        "turn",
        "revolute",
        ["base", "turret"],
        [0.0, 0.0, 0.5],
        "0 0 1",
    );
    text += &joint(
        "shoulder",
        "revolute",
        ["turret", "lower_arm"],
        [0.4, 0.0, 0.6],
        "0 1 0",
    );
    text += &joint(
        "elbow",
        "revolute",
        ["lower_arm", "upper_arm"],
        [0.0, 0.0, 1.3],
        "0 1 0",
    );
    text += &joint(
        "nod",
        "revolute",
        ["upper_arm", "wrist"],
        [1.4, 0.0, 0.2],
        "0 1 0",
    );
    text += &joint(
        "end",
        "fixed",
        ["wrist", "flange"],
        [0.25, 0.0, 0.0],
        "0 0 0",
    );
    // Foot of the linear actuator in front of the shoulder, leaning towards the lower arm.
    text += &joint(
        "foot",
        "revolute",
        ["turret", "cylinder"],
        [1.0, 0.3, 0.5],
        "0 1 0",
    );
    text += &joint(
        "screw",
        "prismatic",
        ["cylinder", "rod"],
        [0.4, 0.0, 0.0],
        "1 0 0",
    );
    text += &joint(
        "crank",
        "revolute",
        ["turret", "crank"],
        [0.4, -0.3, 0.6],
        "0 1 0",
    );
    text += &joint(
        "bar_foot",
        "revolute",
        ["crank", "bar"],
        [-0.4, 0.0, 0.0],
        "0 1 0",
    );
    text + "</robot>"
}

/// Rod to lower arm and bar to upper arm.
const LOOPS: &str = r#"
schema = 1
passive = ["shoulder", "elbow", "foot", "bar_foot"]
home_m = { screw = 0.3 }

[[constraint]]
name = "rod_head"
type = "revolute"
parent = { link = "rod", origin_m = [0.3, 0, 0], axis = [0, 1, 0] }
child = { link = "lower_arm", origin_m = [0.15, 0.3, 0.7] }

[[constraint]]
name = "bar_head"
type = "revolute"
parent = { link = "bar", origin_m = [0, 0, 1.3], axis = [0, 1, 0] }
child = { link = "upper_arm", origin_m = [-0.4, -0.3, 0] }
"#;

fn options() -> UrdfOptions {
    let mut options = UrdfOptions::default();
    options.base = Some("base".into());
    options.tip = Some("flange".into());
    options.loops = Some(LoopFile {
        file: "loops.toml".into(),
        text: LOOPS.into(),
    });
    options.stiffness = JointStiffness::Table {
        file: "k.csv".into(),
        text:
            "name,value,unit\nturn,5e6,N m/rad\nscrew,2e8,N/m\ncrank,4e6,N m/rad\nnod,1e6,N m/rad\n"
                .into(),
    };
    options.section = Some(Section {
        tube: Some(Tube {
            outer_diameter_mm: Some(300.0),
            inner_diameter_mm: Some(260.0),
            ..Tube::default()
        }),
        youngs_modulus_gpa: Some(210.0),
        poissons_ratio: Some(0.3),
        ..Section::default()
    });
    options
}

fn at_home(imported: &Imported, wrench: &Wrench) -> MechanismEquilibrium {
    let m = &imported.model.mechanism;
    let limbs = m
        .limbs()
        .iter()
        .map(|l| LimbPosture {
            commands: l.nominal.home_commands(),
            coordinates: l.nominal.home_coordinates(),
        })
        .collect();
    let posture = m
        .posture(PostureRequest::joints(&m.platforms()[m.tool()].home, limbs))
        .unwrap();
    posture.deflected_by(wrench).unwrap()
}

#[test]
fn the_heavy_arm_has_four_platforms_and_closes() {
    let imported = import(&heavy(), &options());
    assert_eq!(imported.loops, 2);
    let mut actuators = imported.actuators.clone();
    actuators.sort();
    assert_eq!(actuators, ["crank", "nod", "screw", "turn"]);
    let names: Vec<&str> = imported
        .model
        .document
        .platform
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(names, ["turret", "lower_arm", "upper_arm", "flange"]);
    // Every chain ends where its platform is: the loops are closed at home.
    assert!(
        imported.model.warnings.is_empty(),
        "{:?}",
        imported.model.warnings
    );
    assert_eq!(imported.model.mechanism.limbs().len(), 6);
    let mass: f64 = imported.bodies.iter().map(|b| b.1).sum();
    assert!((mass - 3310.0).abs() < 1e-9, "{mass}");
    assert!(notices(&imported).contains("the loops make 4 platforms"));
}

#[test]
fn the_constraint_element_says_the_same_as_the_loop_file() {
    let elements = "<constraint name='rod_head' type='revolute'><parent link='rod'/><parent_origin xyz='0.3 0 0'/><parent_axis xyz='0 1 0'/>
        <child link='lower_arm'/><child_origin xyz='0.15 0.3 0.7'/></constraint>
        <constraint name='bar_head' type='revolute'><parent link='bar'/><parent_origin xyz='0 0 1.3'/><parent_axis xyz='0 1 0'/>
        <child link='upper_arm'/><child_origin xyz='-0.4 -0.3 0'/></constraint></robot>";
    let urdf = heavy().replace("</robot>", elements);
    let passive = ["shoulder", "elbow", "foot", "bar_foot"];
    let given = {
        let mut options = options();
        options.loops = None;
        options.passive = passive.map(str::to_owned).to_vec();
        options.home = [("screw".to_owned(), (MotionKind::Prismatic, 0.3))].into();
        options
    };
    let by_element = import(&urdf, &given);
    let by_file = import(&heavy(), &options());
    assert_eq!(by_element.toml, by_file.toml);
    // Without passive joints nothing can close.
    let none = {
        let mut options = given;
        options.passive = Vec::new();
        options
    };
    let said = import_urdf(&urdf, "heavy.urdf", &none)
        .unwrap_err()
        .to_string();
    assert!(said.contains("the loops stay open by"), "{said}");
    assert!(said.contains("passive = [...]"), "{said}");
}

/// Torques and forces of the drives that hold the weights, by virtual work in the plane of the arm; and
/// how far the flange rises per motion of crank and screw (m/rad, 1).
fn held_by_hand(imported: &Imported) -> ([f64; 2], [f64; 2]) {
    let g = 9.81;
    // At home the parallelogram is exact: lower arm and bar upright, crank and upper arm level up to
    // the angle of the shoulder that the screw sets. All of it from the home values of the model.
    let value = |name: &str| {
        imported
            .model
            .mechanism
            .limbs()
            .iter()
            .find_map(|l| {
                let c = l.nominal.coordinates().iter().find(|c| c.name == name)?;
                Some(c.home)
            })
            .unwrap()
    };
    let (shoulder, elbow, foot, screw) = (value("shoulder"), value("elbow"), value("foot"), 0.3);
    // Position of a point (x, z) of a body turned by `a` about +y.
    let turned = |a: f64, [x, z]: [f64; 2]| [a.cos() * x + a.sin() * z, -a.sin() * x + a.cos() * z];
    // dz of that point per radian of `a`.
    let rise = |a: f64, p: [f64; 2]| -turned(a, p)[0];
    let (lower, upper) = (shoulder, shoulder + elbow);
    // The crank leads the upper arm: with the parallelogram their angles are equal.
    // Crank moves by 1 with the lower arm held: crank, bar (translates with the crank's pin), upper
    // arm, wrist.
    let work_crank = 1200.0 * rise(upper, [-0.9, 0.05])
        + 60.0 * rise(upper, [-0.4, 0.0])
        + 450.0 * rise(upper, [0.5, 0.1])
        + 90.0 * rise(upper, [1.5, 0.2]);
    // Lower arm moves by 1 with the crank held: upper arm keeps its angle and translates.
    let work_lower = 500.0 * rise(lower, [0.05, 0.6])
        + 60.0 * rise(lower, [0.0, 0.6])
        + (450.0 + 90.0) * rise(lower, [0.0, 1.3]);
    // The screw: law of the triangle shoulder, foot, head.
    let [hx, hz] = turned(lower, [0.15, 0.7]);
    let (sx, sz) = (0.4 + hx - 1.0, 0.6 + hz - 0.5);
    let length = (sx * sx + sz * sz).sqrt();
    assert!((length - (0.4 + screw + 0.3)).abs() < 1e-9, "{length}");
    let (ex, ez) = (sx / length, sz / length);
    // Velocity of the head per radian of the lower arm, along and across the screw.
    let (vx, vz) = (hz, -hx);
    let along = vx * ex + vz * ez;
    // The screw's body turns: its angle about +y has x axis (cos, -sin).
    let spin = (-ez * vx + ex * vz) / length; // anticlockwise in x-z
    let turn_rate = -spin; // about +y
    let cylinder = 80.0 * rise(foot, [0.3, 0.02]);
    let rod_turn = 30.0 * rise(foot, [0.4 + screw + 0.2, 0.0]);
    let rod_slide = 30.0 * ez;
    let work_screw = (work_lower + (cylinder + rod_turn) * turn_rate + rod_slide * along) / along;
    let flange = [rise(upper, [1.65, 0.2]), rise(lower, [0.0, 1.3]) / along];
    ([-g * work_crank, -g * work_screw], flange)
}

#[test]
fn figure_drives_of_the_heavy_arm_hold_its_weight() {
    // Stiff enough that the deflected shape is the one at home.
    let mut stiff = options();
    stiff.stiffness = JointStiffness::Table {
        file: "k.csv".into(),
        text: "name,value,unit\nturn,1e15,N m/rad\nscrew,1e15,N/m\ncrank,1e15,N m/rad\nnod,1e15,N m/rad\n".into(),
    };
    if let Some(section) = &mut stiff.section {
        section.youngs_modulus_gpa = Some(2.1e11);
    }
    let imported = import(&heavy(), &stiff);
    let found = at_home(&imported, &Wrench::zero());
    let forces = found.actuator_forces();
    let names = imported.model.mechanism.actuator_names();
    let force = |name: &str| forces[names.iter().position(|n| n.contains(name)).unwrap()];
    let ([crank, screw], _) = held_by_hand(&imported);
    println!("{names:?} {forces:?}; by hand: crank {crank}, screw {screw}");
    let worst = largest_size([
        (force("crank") - crank) / crank,
        (force("screw") - screw) / screw,
    ]);
    figure_at_most(
        "URDF with loops (counterweight, linear actuator, bar): drive forces against statics by hand",
        worst,
        1e-6,
        "relative",
    );
    assert!(found.displacement.0.norm() < 1e-6);
    // Without its counterweight the crank must push the other way: by the weight's own moment.
    let light = heavy().replace("<mass value='1200'/>", "<mass value='1'/>");
    let imported = import(&light, &stiff);
    let forces = at_home(&imported, &Wrench::zero()).actuator_forces();
    let without = forces[names.iter().position(|n| n.contains("crank")).unwrap()];
    let moment = 1199.0 * 9.81 * 0.9;
    assert!(
        (without - crank - moment).abs() < 1e-6 * moment,
        "{without}"
    );
}

/// Two arms that meet.
fn five_bar() -> String {
    let mut urdf = String::from("<robot name='five_bar'><link name='base'/>");
    urdf += &link("left", [0.2, 0.0, 0.0], 8.0);
    urdf += &link("right", [0.2, 0.0, 0.0], 8.0);
    urdf += &link("rod", [0.3, 0.0, 0.0], 6.0);
    urdf += &link("tool", [0.3, 0.0, 0.1], 6.0);
    urdf += &joint(
        "one",
        "revolute",
        ["base", "left"],
        [-0.3, 0.0, 0.0],
        "0 1 0",
    );
    urdf += &joint(
        "two",
        "revolute",
        ["base", "right"],
        [0.3, 0.0, 0.0],
        "0 1 0",
    );
    urdf += &joint(
        "left_elbow",
        "revolute",
        ["left", "tool"],
        [0.4, 0.0, 0.0],
        "0 1 0",
    );
    urdf += &joint(
        "right_elbow",
        "revolute",
        ["right", "rod"],
        [0.4, 0.0, 0.0],
        "0 1 0",
    );
    urdf += "<constraint name='meeting' type='revolute'><parent link='rod'/><parent_origin xyz='0.6 0 0'/><parent_axis xyz='0 1 0'/>
        <child link='tool'/><child_origin xyz='0.6 0 0'/></constraint></robot>";
    urdf
}

fn five_bar_options() -> UrdfOptions {
    let mut options = options();
    options.base = Some("base".into());
    options.tip = Some("tool".into());
    options.loops = None;
    options.passive = vec!["left_elbow".into(), "right_elbow".into()];
    options.home = [("one", -1.9), ("two", -1.2)]
        .map(|(name, angle)| (name.to_owned(), (MotionKind::Revolute, angle)))
        .into();
    options.stiffness = JointStiffness::All(1e6);
    options
}

/// A drive that moves joints of both arms cannot be said in a model: refused with what to do.
#[test]
fn a_mimic_joint_in_another_limb_is_refused() {
    let urdf = five_bar().replace(
        "<joint name='two' type='revolute'>",
        "<joint name='two' type='revolute'><mimic joint='one' multiplier='1' offset='0.7'/>",
    );
    let mut options = five_bar_options();
    options.home.remove("two");
    let said = import_urdf(&urdf, "coupled.urdf", &options)
        .expect_err("two limbs")
        .to_string();
    assert!(
        said.contains("'one' moves joints of two limbs") && said.contains("replace <mimic>"),
        "{said}"
    );
    assert!(said.contains("joint 'two'"), "{said}");
}

/// All limbs run from the base to the tool, so poses can be requested.
#[test]
fn a_parallel_machine_answers_for_poses() {
    let (urdf, options) = (five_bar(), five_bar_options());
    let imported = import(&urdf, &options);
    assert!(
        !notices(&imported).contains("platforms"),
        "{}",
        notices(&imported)
    );
    let m = &imported.model.mechanism;
    assert_eq!(m.limbs().len(), 2);
    let home = m.platforms()[m.tool()].home;
    let posture = m.posture(&home).unwrap();
    assert_eq!(posture.stiffness().unwrap().rank(), 6);
    // Inverse kinematics comes back to the commands at home.
    let mut values = posture.commands();
    values.sort_by(f64::total_cmp);
    assert!((values[0] + 1.9).abs() < 1e-9 && (values[1] + 1.2).abs() < 1e-9);
}

#[test]
fn figure_the_heavy_arm_gives_way_through_its_loops() {
    // Links a million times as stiff as steel: what the flange sinks under a force is what crank, screw and wrist give way.
    let mut soft = options();
    if let Some(section) = &mut soft.section {
        section.youngs_modulus_gpa = Some(2.1e8);
    }
    // Hardly any weight, so that none of it turns with the arm.
    let light = heavy().replace("<mass value='", "<mass value='0.000000");
    let imported = import(&light, &soft);
    let sunk = |force: f64| {
        let wrench = Wrench::new(Vector3::z() * force, Vector3::zeros());
        at_home(&imported, &wrench).displacement.linear().z
    };
    let compliance = (sunk(1.0) - sunk(-1.0)) / 2.0;
    let (_, [crank, screw]) = held_by_hand(&imported);
    let by_hand = crank.powi(2) / 4e6 + screw.powi(2) / 2e8 + 0.25_f64.powi(2) / 1e6;
    figure_at_most(
        "URDF with loops: compliance of the flange against springs by hand",
        (compliance / by_hand - 1.0).abs(),
        1e-6,
        "relative",
    );
}
