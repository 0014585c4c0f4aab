//! Condensing limbs to 6 x 6 and solving for the platforms gives what the whole flattened system
//! gives; a chain cut at a node into two limbs over a free platform is the chain.

use crate::common::{
    Orthoglide, Recipe, Rng, arm, assert_equilibrium, cases, orthoglide_point, random_chain,
    same_stiffness, scaled_error,
};
use crate::oracle::Flat;
use kinetostat::{
    Chain, Directions, Limb, Mechanism, Platform, Pose, Posture, PostureRequest, Twist, Wrench,
    machine::LimbPosture,
    spatial::{moved, pose_residual},
};
use kinetostat_testing::{Worst, largest};
use nalgebra::{Matrix3, Vector3, Vector6};
use proptest::prelude::*;

/// How far the condensed answer is from the flattened one.
pub struct Apart {
    /// Pose of the tool, m and rad.
    pub tool: f64,
    /// Wrenches of the limbs, as a share of the largest.
    pub wrench: f64,
    /// Coordinates, m or rad.
    pub coordinates: f64,
    /// Stiffness, relative.
    pub stiffness: f64,
}

/// Solves both ways from rest and compares everything.
#[track_caller]
pub fn apart(label: &str, posture: &Posture, wrench: &Wrench) -> Apart {
    let e = posture
        .deflected_by(wrench)
        .unwrap_or_else(|error| panic!("{label}: {error}"));
    assert_equilibrium(posture, &e);
    let mut flat = Flat::at_rest(posture);
    flat.load = wrench.0;
    flat.solve(false);
    let tool = posture.mechanism().tool();
    let size = largest(flat.wrenches.iter().map(Vector6::norm).chain([1.0]));
    let (mut wrenches, mut coordinates) = (Worst::new(), Worst::new());
    for (i, limb) in e.limbs.iter().enumerate() {
        wrenches.add((limb.wrench.0 - flat.wrenches[i]).norm() / size);
        assert_eq!(limb.coordinates.len(), flat.coordinates[i].len(), "{label}");
        for (a, b) in limb.coordinates.iter().zip(&flat.coordinates[i]) {
            coordinates.add(a - b);
        }
    }
    Apart {
        tool: pose_residual(&e.tool, &flat.platforms[tool]).0.norm(),
        wrench: wrenches.of(flat.wrenches.len()),
        coordinates: coordinates.value(),
        stiffness: scaled_error(&e.stiffness.matrix, &flat.stiffness()),
    }
}

#[track_caller]
fn compare(label: &str, posture: &Posture, wrench: &Wrench) {
    let d = apart(label, posture, wrench);
    assert!(d.tool < 1e-10, "{label}: tool {:e}", d.tool);
    assert!(d.wrench < 1e-8, "{label}: limb wrenches {:e}", d.wrench);
    assert!(
        d.coordinates < 1e-10,
        "{label}: coordinates {:e}",
        d.coordinates
    );
    assert!(d.stiffness < 1e-8, "{label}: stiffness {:e}", d.stiffness);
}

#[test]
fn the_orthoglide_with_errors_under_load_and_gravity() {
    let mut rng = Rng(11);
    let machine = Orthoglide {
        line_error: 1_f64.to_radians(),
        slide_error: 5e-4,
        ..Default::default()
    }
    .build();
    for index in 0..5 {
        let posture = machine.posture(&orthoglide_point(index)).unwrap();
        compare(&format!("Q{index}"), &posture, &rng.wrench(220.0, 20.0));
        let other = machine.with_tool(&rng.pose(0.15, 1.5));
        let posture = other
            .posture(&(orthoglide_point(index) * other.platforms()[1].home))
            .unwrap();
        compare(
            &format!("Q{index} tool"),
            &posture,
            &rng.wrench(150.0, 20.0),
        );
    }
}

#[test]
fn a_heavy_arm_under_gravity_and_two_kilonewton() {
    let chain = arm(true);
    let machine =
        Mechanism::serial(chain, Pose::identity(), Vector3::new(0.0, 0.0, -9.81)).unwrap();
    let mut rng = Rng(3);
    let (low, high) = (
        [-2.5, -1.0, -0.6, -2.5, -1.8, -2.5],
        [2.5, 1.0, 1.6, 2.5, 1.8, 2.5],
    );
    for pose in 0..5 {
        let commands: Vec<f64> = (0..6).map(|i| rng.between(low[i], high[i])).collect();
        let limb = &machine.limbs()[0].nominal;
        let joints = LimbPosture {
            commands,
            coordinates: limb.home_coordinates(),
        };
        let target = kinetostat::model::unloaded_tip(
            limb,
            &Pose::identity(),
            &joints.coordinates,
            &joints.commands,
        );
        let posture = machine
            .posture(PostureRequest::joints(&target, vec![joints]))
            .unwrap();
        compare(
            &format!("pose {pose}"),
            &posture,
            &rng.wrench(2000.0, 300.0),
        );
    }
}

/// A chain in two parts with the description of both and of the whole.
pub struct Cut {
    whole: Mechanism,
    pub parts: Mechanism,
    whole_posture: Vec<LimbPosture>,
    pub part_posture: Vec<LimbPosture>,
    pub target: Pose,
}

/// The parts joined at a platform whose frame is `platform` seen from the first part's tip.
pub fn cut(rng: &mut Rng, passive: usize, mass: f64) -> Cut {
    let recipe = Recipe {
        stages: 2,
        passive,
        preload: 0.02,
        ..Recipe::default()
    };
    let first = random_chain(rng, &recipe);
    let second = random_chain(
        rng,
        &Recipe {
            passive: 0,
            ..recipe
        },
    );
    let gravity = rng.axis() * 9.81;
    let com = rng.vector(0.1);
    let join = rng.pose(0.2, 1.0);
    // The whole, rebuilt from the elements of both parts.
    let whole = joined(&first.chain, &join, mass, com, &second.chain);
    let mut builder = Mechanism::builder("parts").gravity(gravity);
    let mut middle = Platform::new("middle", Pose::identity());
    let none: Vec<f64> = vec![];
    let at = |c: &Chain, base: &Pose, x: &[f64], q: &[f64]| {
        kinetostat::model::unloaded_tip(c, base, x, q)
    };
    middle.home = at(
        &first.chain,
        &Pose::identity(),
        &first.posture,
        &first.commands,
    ) * join;
    middle.mass = mass;
    middle.centre_of_mass = com;
    let target = at(
        &second.chain,
        &middle.home,
        &second.posture,
        &second.commands,
    );
    let _ = none;
    let middle = builder.platform(middle);
    let tool = builder.platform(Platform::new("tool", target));
    let limb = |name: &str, from, to, tip: Pose, chain: &Chain| {
        Limb::between(name, from, to, chain.clone()).fixed_at(tip)
    };
    let parts = builder
        .limb(limb("first", 0, middle, join.inverse(), &first.chain))
        .limb(limb(
            "second",
            middle,
            tool,
            Pose::identity(),
            &second.chain,
        ))
        .build()
        .unwrap();
    let whole = Mechanism::serial(whole, target, gravity).unwrap();
    let posture = |c: &Vec<f64>, x: &Vec<f64>| LimbPosture {
        commands: c.clone(),
        coordinates: x.clone(),
    };
    Cut {
        whole_posture: vec![posture(
            &[first.commands.clone(), second.commands.clone()].concat(),
            &[first.posture.clone(), second.posture.clone()].concat(),
        )],
        part_posture: vec![
            posture(&first.commands, &first.posture),
            posture(&second.commands, &second.posture),
        ],
        whole,
        parts,
        target,
    }
}

/// Serialises two chains, joins their lists and reads them back: an independent way to one chain.
fn joined(a: &Chain, join: &Pose, mass: f64, com: Vector3<f64>, b: &Chain) -> Chain {
    use serde_json::{Value, json};
    let mut first = serde_json::to_value(a).unwrap();
    let second = serde_json::to_value(b).unwrap();
    let (n, r) = (a.coordinate_count(), a.actuators().len());
    let list = |v: &Value, key: &str| v[key].as_array().unwrap().clone();
    // The first chain's tip becomes an inner node; the joint body sits behind it.
    let nodes = a.nodes().len();
    let mut names: Vec<String> = a.nodes().iter().map(|s| format!("1.{s}")).collect();
    let mut elements = list(&first, "elements");
    let rigid = |p: &Pose| json!({ "Rigid": p });
    elements.push(rigid(join));
    let offset = Pose::translation(com.x, com.y, com.z);
    elements.push(rigid(&offset));
    elements.push(json!({ "Node": nodes }));
    names.push("joint".into());
    elements.push(rigid(&offset.inverse()));
    let shift = |v: &mut Value, by: usize| *v = json!(v.as_u64().unwrap() as usize + by);
    for mut e in list(&second, "elements") {
        if let Some(node) = e.get_mut("Node") {
            shift(node, nodes + 1);
        }
        if let Some(m) = e.get_mut("Motion") {
            if !m["coordinate"].is_null() {
                shift(&mut m["coordinate"]["index"], n);
            }
            if !m["command"].is_null() {
                shift(&mut m["command"]["index"], r);
            }
        }
        elements.push(e);
    }
    names.extend(b.nodes().iter().map(|s| {
        if s == "tip" {
            s.clone()
        } else {
            format!("2.{s}")
        }
    }));
    let renamed = |key: &str| {
        let mut all = Vec::new();
        for (part, v) in [(1, &first), (2, &second)] {
            for mut item in list(v, key) {
                item["name"] = json!(format!("{part}.{}", item["name"].as_str().unwrap()));
                if part == 2 {
                    match key {
                        "springs" => shift(&mut item["first"], n),
                        "bodies" => shift(&mut item["node"], nodes + 1),
                        "actuators" if !item["coordinate"].is_null() => {
                            shift(&mut item["coordinate"], n)
                        }
                        _ => {}
                    }
                }
                all.push(item);
            }
        }
        all
    };
    let (coordinates, actuators, springs, mut bodies) = (
        renamed("coordinates"),
        renamed("actuators"),
        renamed("springs"),
        renamed("bodies"),
    );
    bodies.push(
        json!({ "name": "joint", "node": nodes, "mass": mass, "inertia": Matrix3::<f64>::zeros() }),
    );
    first["elements"] = json!(elements);
    first["nodes"] = json!(names);
    first["coordinates"] = json!(coordinates);
    first["actuators"] = json!(actuators);
    first["springs"] = json!(springs);
    first["bodies"] = json!(bodies);
    serde_json::from_value(first).unwrap()
}

proptest! {
    #![proptest_config(cases(16))]
    #[test]
    fn a_chain_cut_at_a_free_platform_is_the_chain(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let mass = if rng.below(2) == 0 { 0.0 } else { 12.0 };
        let c = cut(&mut rng, 0, mass);
        let whole = c.whole.posture(PostureRequest::joints(&c.target, c.whole_posture.clone())).unwrap();
        let parts = c.parts.posture(PostureRequest::joints(&c.target, c.part_posture.clone())).unwrap();
        let wrench = rng.wrench(100.0, 12.0);
        let a = whole.deflected_by(&wrench).unwrap();
        let b = parts.deflected_by(&wrench).unwrap();
        assert_equilibrium(&whole, &a);
        assert_equilibrium(&parts, &b);
        let residual = pose_residual(&a.tool, &b.tool);
        prop_assert!(residual.0.norm() < 1e-10, "{residual:?}");
        let error = scaled_error(&b.stiffness.matrix, &a.stiffness.matrix);
        prop_assert!(error < 1e-8, "stiffness {error:e}");
        let (stored, again) = (a.limbs[0].energy, b.limbs.iter().map(|l| l.energy).sum::<f64>());
        prop_assert!((stored - again).abs() < 1e-8 * stored);
        // And the flattened oracle agrees, with the body of the second limb on the middle platform.
        compare("parts", &parts, &wrench);
    }

    #[test]
    fn random_chains_agree_with_the_flattened_system(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 0, preload: 0.02, ..Recipe::default() });
        let machine = Mechanism::serial(r.chain.clone(), Pose::identity(), rng.axis() * 9.81).unwrap();
        let joints = LimbPosture { commands: r.commands.clone(), coordinates: r.posture.clone() };
        let target = kinetostat::model::unloaded_tip(&r.chain, &Pose::identity(), &r.posture, &r.commands);
        let posture = machine.posture(PostureRequest::joints(&target, vec![joints])).unwrap();
        compare("random", &posture, &rng.wrench(100.0, 10.0));
    }

    #[test]
    fn a_prescribed_pose_of_the_tool_leaves_other_platforms_free(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let c = cut(&mut rng, 1, 5.0);
        let whole = c.whole.posture(PostureRequest::joints(&c.target, c.whole_posture.clone())).unwrap();
        let parts = c.parts.posture(PostureRequest::joints(&c.target, c.part_posture.clone())).unwrap();
        let pose = moved(&c.target, &Twist::new(rng.vector(0.003), rng.vector(0.01)));
        let a = whole.wrench_at(&pose).unwrap();
        assert_equilibrium(&whole, &a);
        let b = parts.wrench_at(&pose).unwrap();
        assert_equilibrium(&parts, &b);
        let d = (a.wrench.0 - b.wrench.0).norm() / a.wrench.0.norm();
        prop_assert!(d < 1e-7, "wrench {d:e}");
        let error = scaled_error(&b.stiffness.matrix, &a.stiffness.matrix);
        prop_assert!(error < 1e-7, "stiffness {error:e}");
    }
}

#[test]
fn the_unloaded_stiffness_of_several_platforms_is_condensed_or_refused() {
    let mut rng = Rng(5);
    let c = cut(&mut rng, 0, 0.0);
    let whole = c
        .whole
        .posture(PostureRequest::joints(&c.target, c.whole_posture.clone()))
        .unwrap();
    let parts = c
        .parts
        .posture(PostureRequest::joints(&c.target, c.part_posture.clone()))
        .unwrap();
    let expected = whole.stiffness().unwrap().cartesian.matrix;
    if let Ok(k) = parts.stiffness() {
        same_stiffness("condensed", &k.cartesian.matrix, &expected, 1e-8);
    }
}

#[test]
fn compensation_of_several_platforms_closes_or_is_refused() {
    let mut rng = Rng(5);
    let c = cut(&mut rng, 0, 0.0);
    let parts = c
        .parts
        .posture(PostureRequest::joints(&c.target, c.part_posture.clone()))
        .unwrap();
    let wrench = rng.wrench(50.0, 5.0);
    let position = Directions::POSITION;
    let found = kinetostat::compensation::compensate_from(
        &parts,
        &c.target,
        &wrench,
        position,
        parts.rest_state(),
    );
    if let Err(error) = &found {
        println!("refused: {error}");
    }
    if let Ok(found) = found {
        let again = found.posture.deflected_by(&wrench).unwrap();
        let residual = pose_residual(&again.tool, &c.target).linear().norm();
        assert!(
            residual < 1e-10,
            "misses by {residual:e} m and reports success"
        );
    }
}

#[test]
fn another_tool_point_keeps_limbs_that_start_at_the_tool() {
    // A counterweight hangs on the tool: platform 'weight' is held by a limb from the tool.
    let mut rng = Rng(9);
    let k = rng.spring_matrix(1e5, 1e3);
    let arm = Chain::builder("arm")
        .translation(Vector3::x() * 0.5)
        .spring6("s", &k, [0.0; 6])
        .build()
        .unwrap();
    let hanger = Chain::builder("hanger")
        .translation(Vector3::y() * 0.3)
        .spring6("s", &k, [0.0; 6])
        .build()
        .unwrap();
    let home = Pose::translation(0.5, 0.0, 0.0);
    let mut builder = Mechanism::builder("hanging").gravity(Vector3::new(0.0, 0.0, -9.81));
    let mut weight = Platform::new("weight", Pose::translation(0.5, 0.3, 0.0));
    weight.mass = 10.0;
    let weight = builder.platform(weight);
    let tool = builder.platform(Platform::new("tool", home));
    let limb = |name: &str, from, to, chain: &Chain| Limb::between(name, from, to, chain.clone());
    let machine = builder
        .limb(limb("arm", 0, tool, &arm))
        .limb(limb("hanger", tool, weight, &hanger))
        .build()
        .unwrap();
    let joints = || {
        [&arm, &hanger]
            .map(|c| LimbPosture {
                commands: vec![],
                coordinates: c.home_coordinates(),
            })
            .to_vec()
    };
    let posture = machine
        .posture(PostureRequest::joints(&home, joints()))
        .unwrap();
    compare("hanging", &posture, &Wrench::zero());
    let e = posture.deflected_by(&Wrench::zero()).unwrap();
    let tip = Pose::translation(0.0, 0.0, 0.2);
    let other = machine.with_tool(&tip);
    let there = other
        .posture(PostureRequest::joints(&(home * tip), joints()))
        .unwrap();
    let o = there.deflected_by(&Wrench::zero()).unwrap();
    let residual = pose_residual(&(e.tool * tip), &o.tool);
    assert!(residual.0.norm() < 1e-10, "{residual:?}");
}
