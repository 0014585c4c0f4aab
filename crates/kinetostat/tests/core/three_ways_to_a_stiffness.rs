//! Block inverse [R 3.7, 4.27], closed form [R 3.10, 4.28] and recursion [R 3.11, 3.16] agree; each
//! says when it does not apply; what a passive joint does to a link [R Tables 3.1-3.3].

use crate::beam_tables_3_2_and_3_3::{expand, section};
use crate::common::{Recipe, Rng, cases, close, golden, random_chain, scaled_error};
use kinetostat::{
    BeamSection, Chain, DirectionKind, EndCondition, Load, MotionKind, Pose, Settings, Twist,
    Wrench,
    model::Role,
    reference::{
        Axis, ChainBlocks, Inapplicable, eliminate_passive, planar_beam, planar_with_hinge_at_end,
        planar_with_slide_along_x, planar_with_slide_along_y, with_hinge_at_end,
        with_hinge_at_root, with_slide, with_spherical_joint_at_end,
    },
    solve_chain,
    spatial::moved,
    unloaded_stiffness,
};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6, vector};
use proptest::prelude::*;

fn shuffled(rng: &mut Rng, count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, rng.below(i + 1));
    }
    order
}

proptest! {
    #![proptest_config(cases(64))]
    #[test]
    fn three_ways_agree_in_any_order_of_elimination(seed in any::<u64>(), passive in 0_usize..=6) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 4, passive, ..Recipe::default() });
        let blocks = ChainBlocks::unloaded(&r.chain, &r.base, &r.posture, &r.commands).unwrap();
        let k = unloaded_stiffness(&r.chain, &r.base, &r.posture, &r.commands).unwrap();
        let block = blocks.block_inverse().unwrap();
        prop_assume!(k.cartesian.matrix.largest_entry() > 1.0);
        // Six passive joints free everything: then all is rounding of the locked chain.
        let locked = blocks.recursion(&[]).unwrap().matrix;
        let off = |m: &Matrix6<f64>| {
            let size = |r: usize| locked.fixed_view::<3, 3>(r, r).largest_entry();
            let mut worst = Worst::new();
            for a in [0, 3] {
                for b in [0, 3] {
                    let d = (m - k.cartesian.matrix).fixed_view::<3, 3>(a, b).largest_entry();
                    worst.add(d / (size(a) * size(b)).sqrt());
                }
            }
            worst.value()
        };
        prop_assert!(off(&block) < 1e-10, "block inverse: {:e}", off(&block));
        let count = blocks.passive_joints().len();
        let redundant = !k.redundant_passive.is_empty();
        match blocks.closed_form() {
            Ok(closed) => prop_assert!(off(&closed) < 1e-10, "closed form: {:e}", off(&closed)),
            Err(why) => {
                prop_assert!(redundant, "{why}");
                prop_assert!(matches!(why, Inapplicable::RedundantPassiveJoints(_)));
            }
        }
        for _ in 0..3 {
            let order = shuffled(&mut rng, count);
            let recursion = blocks.recursion(&order).unwrap();
            prop_assert!(off(&recursion.matrix) < 1e-10, "{order:?}: {:e}", off(&recursion.matrix));
            prop_assert_eq!(recursion.skipped.is_empty(), !redundant);
            prop_assert_eq!(recursion.pivots.len(), count);
        }
    }

    /// `H` of the end moment and of node moments is not symmetric: [R 4.27-4.30] hold as they are.
    #[test]
    fn the_loaded_closed_form_agrees_although_the_hessian_is_not_symmetric(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let recipe = Recipe { stages: 3, passive: 3, preload: 0.03, ..Recipe::default() };
        let r = random_chain(&mut rng, &recipe);
        let target = moved(&r.tip(), &Twist::new(rng.vector(0.01), rng.vector(0.03)));
        let mut problem = r.problem(EndCondition::pose(target));
        let node = rng.below(r.chain.nodes().len());
        problem.loads = vec![
            Load::gravity(rng.axis() * 9.81),
            Load::dead(node, rng.wrench(150.0, 25.0)),
            Load::follower(node, rng.wrench(80.0, 8.0)),
        ];
        let Ok(e) = solve_chain(&problem, &Settings::default()) else { return Ok(()); };
        prop_assert!(!e.conservative);
        let blocks = ChainBlocks::loaded(&problem, &e).unwrap();
        prop_assert_eq!(blocks.closed_form(), Err(Inapplicable::Loaded));
        let k = &e.stiffness;
        let closed = match blocks.loaded_closed_form() {
            Ok(closed) => closed,
            Err(why) => {
                prop_assert!(!k.redundant_passive.is_empty(), "{why}");
                return Ok(());
            }
        };
        let error = scaled_error(&closed.cartesian, &k.cartesian.matrix);
        prop_assert!(error < 1e-8, "4.28: {error:e}");
        let block = scaled_error(&blocks.block_inverse().unwrap(), &k.cartesian.matrix);
        prop_assert!(block < 1e-8, "4.27: {block:e}");
        let q = (&closed.passive - &k.passive).largest_entry() / k.passive.largest_entry().max(1e-12);
        prop_assert!(k.passive.is_empty() || q < 1e-8, "4.29: {q:e}");
        let t = (&closed.springs - &k.springs).largest_entry() / k.springs.largest_entry();
        prop_assert!(t < 1e-8, "4.30: {t:e}");
    }
}

fn beam_with(joint: impl Fn(kinetostat::ChainBuilder) -> kinetostat::ChainBuilder) -> Chain {
    let tube = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    joint(Chain::builder("beam").link("rod", &tube, 0.8))
        .build()
        .unwrap()
}

#[test]
fn the_closed_form_says_why_it_does_not_apply() {
    let base = Pose::identity();
    let blocks = |chain: &Chain| {
        ChainBlocks::unloaded(chain, &base, &chain.home_coordinates(), &[]).unwrap()
    };

    // The same hinge twice.
    let twice = beam_with(|b| {
        b.passive("a", MotionKind::Revolute, Vector3::z(), 0.0)
            .passive("b", MotionKind::Revolute, Vector3::z(), 0.0)
    });
    let why = blocks(&twice).closed_form().unwrap_err();
    assert_eq!(
        why,
        Inapplicable::RedundantPassiveJoints(vec!["a".into(), "b".into()])
    );
    assert!(why.to_string().contains("a, b"), "{why}");
    for order in [[0, 1], [1, 0]] {
        let recursion = blocks(&twice).recursion(&order).unwrap();
        assert_eq!(recursion.skipped, [["a", "b"][order[1]]]);
        let once = beam_with(|b| b.passive("a", MotionKind::Revolute, Vector3::z(), 0.0));
        let expected = blocks(&once).closed_form().unwrap();
        assert!(scaled_error(&recursion.matrix, &expected) < 1e-12);
        let inverse = blocks(&twice).block_inverse().unwrap();
        assert!(scaled_error(&inverse, &expected) < 1e-10);
    }
    assert_eq!(
        blocks(&twice).recursion(&[0, 0]),
        Err(Inapplicable::NotAnOrder(2))
    );
    assert_eq!(
        blocks(&twice).recursion(&[2]),
        Err(Inapplicable::NotAnOrder(2))
    );

    // One torsion spring between rigid bars: the springs reach one direction of six.
    let planar = Chain::builder("bars")
        .passive("q", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(vector![0.5, 0.2, 0.0])
        .spring("t", MotionKind::Revolute, Vector3::z(), 40.0, 0.0)
        .translation(vector![0.5, 0.0, 0.0])
        .build()
        .unwrap();
    let why = Inapplicable::SpringsDoNotReach(1);
    assert_eq!(blocks(&planar).closed_form(), Err(why.clone()));
    assert_eq!(blocks(&planar).recursion(&[0]), Err(why.clone()));
    assert_eq!(blocks(&planar).loaded_closed_form(), Err(why));
    // The bordered system answers, and so does the block inverse: 3 rigid, 1 free, 1 finite... .
    let k = unloaded_stiffness(&planar, &base, &[0.0, 0.0], &[]).unwrap();
    let inverse = blocks(&planar).block_inverse().unwrap();
    assert!(scaled_error(&inverse, &k.cartesian.matrix) < 1e-10);
}

#[test]
fn directions_name_the_joints_that_take_part_in_them() {
    let chain = beam_with(|b| {
        b.passive("q2", MotionKind::Prismatic, Vector3::y(), 0.0)
            .passive("q3", MotionKind::Revolute, Vector3::z(), 0.0)
    });
    let k = unloaded_stiffness(&chain, &Pose::identity(), &[0.0; 8], &[]).unwrap();
    let free: Vec<_> = k
        .directions
        .iter()
        .filter(|d| d.kind == DirectionKind::Free)
        .collect();
    assert_eq!(free.len(), 2);
    assert_eq!(free[0].description(), "free: moves along y by q2");
    assert_eq!(free[1].description(), "free: turns about z by q3");
    for (direction, joint) in free.iter().zip(["q2", "q3"]) {
        let [share] = &direction.participation[..] else {
            panic!("{direction:?}")
        };
        assert_eq!((share.name.as_str(), share.role), (joint, Role::Passive));
        close("share", share.share, 1.0, 1e-12);
    }
    // What a push along x moves: the rod's own spring.
    let all = k.participation(&chain, &Twist::new(Vector3::x(), Vector3::zeros()));
    assert_eq!(all.len(), 8);
    close("rod", all[0].motion, 1.0, 1e-12);
    assert!(all[1..].iter().all(|s| s.motion.abs() < 1e-12), "{all:?}");

    // A strut's spin is shared by both of its joints.
    let tube = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    let strut = Chain::builder("strut")
        .passive_spherical("lower")
        .link("rod", &tube, 0.8)
        .passive_spherical("upper")
        .build()
        .unwrap();
    let k = unloaded_stiffness(&strut, &Pose::identity(), &[0.0; 12], &[]).unwrap();
    let spin: Vec<&str> = k
        .directions
        .iter()
        .filter(|d| d.kind == DirectionKind::Free && d.twist.angular().x.abs() > 1e-9)
        .flat_map(|d| d.participation.iter().map(|s| s.name.as_str()))
        .collect();
    assert_eq!(spin, ["lower.x", "upper.x"]);
    let lower = k
        .directions
        .iter()
        .find(|d| d.participation.iter().any(|s| s.name == "lower.z"));
    let words = lower.unwrap().description();
    assert!(
        words.starts_with("free: turns about z on an axis [-0.8000, 0.0000, 0.0000] m"),
        "{words}"
    );
}

#[test]
fn compliance_exists_where_the_stiffness_is_infinite() {
    // Slide, rigid bar, torsion spring, rigid bar: y and z rigid, rotations about x and y too.
    let chain = Chain::builder("bars")
        .passive("slide", MotionKind::Prismatic, Vector3::x(), 0.0)
        .translation(vector![0.5, 0.0, 0.0])
        .spring("t", MotionKind::Revolute, Vector3::z(), 40.0, 0.0)
        .translation(vector![0.5, 0.0, 0.0])
        .build()
        .unwrap();
    let blocks = ChainBlocks::unloaded(&chain, &Pose::identity(), &[0.0, 0.0], &[]).unwrap();
    let c = blocks.compliance();
    assert_eq!((c.rank(), c.free.len(), c.rigid.len()), (1, 1, 4));
    let column = Vector6::new(0.0, 0.5, 0.0, 0.0, 0.0, 1.0);
    let expected = column * column.transpose() / 40.0;
    assert!(
        (c.springs - expected).largest_entry() < 1e-14,
        "{}",
        c.springs
    );
    let free = c.free[0].0;
    assert!(
        (free.abs() - Vector6::x()).largest_entry() < 1e-12,
        "{free}"
    );
    assert!(
        c.twist_under(&Wrench::new(Vector3::x(), Vector3::zeros()))
            .is_none()
    );
    let push = Wrench::new(vector![0.0, 8.0, 3.0], vector![1.0, 0.0, 0.0]);
    let twist = c.twist_under(&push).unwrap();
    assert!((twist.0 - column * (4.0 / 40.0)).largest_entry() < 1e-14);

    // Where both exist they are inverse on the directions that are neither free nor rigid.
    for seed in 0..20 {
        let mut rng = Rng(seed);
        let recipe = Recipe {
            stages: 3,
            passive: 3,
            ..Recipe::default()
        };
        let r = random_chain(&mut rng, &recipe);
        let k = unloaded_stiffness(&r.chain, &r.base, &r.posture, &r.commands).unwrap();
        let blocks = ChainBlocks::unloaded(&r.chain, &r.base, &r.posture, &r.commands).unwrap();
        let c = blocks.compliance();
        let k = k.cartesian.matrix;
        assert!(scaled_error(&(k * c.springs * k), &k) < 1e-9);
        for free in &c.free {
            assert!((k * free.0).largest_entry() < 1e-8 * k.largest_entry());
        }
    }
}

#[test]
fn rules_with_names_give_tables_3_2_and_3_3() {
    let axis = |case: &serde_json::Value| match case["axis"].as_str().unwrap() {
        "x" => Axis::X,
        "y" => Axis::Y,
        _ => Axis::Z,
    };
    for (file, root) in [("table_3_2.json", false), ("table_3_3.json", true)] {
        let file = golden(file);
        let (section, length) = section(&file["beam"]);
        let k0 = section.cantilever(length).unwrap();
        for case in file["cases"].as_array().unwrap() {
            let slide = case["kind"] == "prismatic";
            let k = match (slide, root) {
                (true, _) => with_slide(&k0, axis(case)).unwrap(),
                (false, false) => with_hinge_at_end(&k0, axis(case)).unwrap(),
                (false, true) => with_hinge_at_root(&k0, axis(case), length).unwrap(),
            };
            let expected = expand(&case["printed"]).component_mul(&k0);
            let label = case["joint"].as_str().unwrap();
            for i in 0..6 {
                for j in 0..6 {
                    let size = (k0[(i, i)] * k0[(j, j)]).sqrt();
                    close(label, k[(i, j)], expected[(i, j)], 1e-14 * size);
                }
            }
        }
    }
}

/// [R 3.27] and the sequence after it: the leg of a Stewart-Gough platform.
#[test]
fn five_joints_leave_a_leg_its_traction_only() {
    let file = golden("table_3_2.json");
    let (section, length) = section(&file["beam"]);
    let k0 = section.cantilever(length).unwrap();
    let spherical = with_spherical_joint_at_end(&k0).unwrap();
    let mut expected = Matrix6::zeros();
    for (i, share) in [(0, 1.0), (1, 0.25), (2, 0.25)] {
        expected[(i, i)] = share * k0[(i, i)];
    }
    assert!(
        scaled_error(
            &(spherical + Matrix6::identity()),
            &(expected + Matrix6::identity())
        ) < 1e-13
    );
    let mut k = spherical;
    for axis in [Axis::Y, Axis::Z] {
        k = with_hinge_at_root(&k, axis, length).unwrap();
    }
    expected.fill(0.0);
    expected[(0, 0)] = k0[(0, 0)];
    assert!(
        (k - expected).largest_entry() < 1e-14 * k0.largest_entry(),
        "{k}"
    );
    // What is free stays free, and is said to be.
    let again = eliminate_passive(&k, &Vector6::new(0.0, length, 0.0, 0.0, 0.0, 1.0)).unwrap();
    assert!(again.already_free);
    assert_eq!(again.matrix, k);
    let spin = eliminate_passive(&k, &Vector6::ith(3, 1.0)).unwrap();
    assert!(spin.already_free);
    assert_eq!(spin.pivot, 0.0);
}

/// All eight matrices of [R Table 3.1]: a general planar link and the classical beam.
#[test]
fn planar_rules_give_table_3_1() {
    let (ea, ei, l) = (2.1e11 * 6e-4, 2.1e11 * 7e-8, 0.7);
    let beam = planar_beam(ea, ei, l).unwrap();
    let (c, k22, k33) = (-6.0 * ei / (l * l), 12.0 * ei / l.powi(3), 4.0 * ei / l);
    let same = |a: Matrix3<f64>, b: Matrix3<f64>| {
        assert!((a - b).largest_entry() < 1e-15 * ea / l, "{a}{b}")
    };
    same(
        beam,
        Matrix3::new(ea / l, 0.0, 0.0, 0.0, k22, c, 0.0, c, k33),
    );
    same(
        planar_with_slide_along_x(&beam).unwrap(),
        Matrix3::new(0.0, 0.0, 0.0, 0.0, k22, c, 0.0, c, k33),
    );
    let mut expected = Matrix3::zeros();
    expected[(0, 0)] = ea / l;
    expected[(2, 2)] = ei / l;
    same(planar_with_slide_along_y(&beam).unwrap(), expected);
    expected[(2, 2)] = 0.0;
    expected[(1, 1)] = 3.0 * ei / l.powi(3);
    same(planar_with_hinge_at_end(&beam).unwrap(), expected);

    // The printed formulas for any matrix, and the same through a chain.
    let k = Matrix3::new(90.0, 11.0, -7.0, 11.0, 60.0, 13.0, -7.0, 13.0, 40.0);
    type Rule = fn(&Matrix3<f64>) -> kinetostat::Result<Matrix3<f64>>;
    let rules: [(Rule, usize); 3] = [
        (planar_with_slide_along_x, 0),
        (planar_with_slide_along_y, 1),
        (planar_with_hinge_at_end, 2),
    ];
    for (rule, p) in rules {
        let printed = Matrix3::from_fn(|i, j| k[(i, j)] - k[(i, p)] * k[(p, j)] / k[(p, p)]);
        assert!((rule(&k).unwrap() - printed).largest_entry() < 1e-13);
        let place = [0, 1, 5];
        let mut spatial = Matrix6::from_diagonal_element(50.0);
        for i in 0..3 {
            for j in 0..3 {
                spatial[(place[i], place[j])] = k[(i, j)];
            }
        }
        let (kind, axis) = [
            (MotionKind::Prismatic, Vector3::x()),
            (MotionKind::Prismatic, Vector3::y()),
            (MotionKind::Revolute, Vector3::z()),
        ][p];
        let chain = Chain::builder("link")
            .spring6("s", &spatial, [0.0; 6])
            .passive("q", kind, axis, 0.0)
            .build()
            .unwrap();
        let own = unloaded_stiffness(&chain, &Pose::identity(), &[0.0; 7], &[]).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let found = own.cartesian.matrix[(place[i], place[j])];
                close("chain", found, printed[(i, j)], 1e-11);
            }
        }
    }
}
