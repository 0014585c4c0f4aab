//! The model files of `benches/models` are the machines of the benchmark cases: numbers at one posture of each
//! against independent computations.
//!
//! Provenance of the numbers: W1 from the textbook product J K^-1 J^T of one posture and W3, W4, W5 from
//! Newton iterations with dense matrices (residual below 1e-12), all in numpy from the constants of the
//! benchmark and not from a model file; W2 from its closed form, every leg a two-force member,
//! K_C = sum of k w w^T. Units N, m, rad.

use std::path::{Path, PathBuf};

use kinetostat::Wrench;
use kinetostat::batch::{Batch, Status};
use kinetostat_bench::{Answers, BenchQuantity, Places, Task, sample};
use kinetostat_testing::largest_size;

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../benches/models/{name}.toml"))
}

fn answers(name: &str, quantity: BenchQuantity, places: Places, wrench: &[f64]) -> Answers {
    let task = Task::open(&model(name), quantity, places, wrench).expect("a task");
    let answers = task.answers(1).expect("answers");
    assert_eq!(answers.not_found, 0, "{name}");
    answers
}

/// Largest difference to the largest number.
fn apart(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    largest_size(found.iter().zip(expected).map(|(a, b)| a - b))
        / largest_size(expected.iter().copied())
}

fn upper(matrix: &[f64]) -> Vec<f64> {
    (0..6)
        .flat_map(|i| (i..6).map(move |j| matrix[6 * i + j]))
        .collect()
}

const JOINTS: [f64; 6] = [
    0.05910812350128358,
    0.9009273926518706,
    -0.28284885201680576,
    2.243247235686219,
    -0.6774067727622524,
    -0.3833677551371215,
];
const WRENCH: [f64; 6] = [
    545.9613611120096,
    -1509.628909689111,
    -1192.8733156557691,
    -225.94102648698583,
    166.55054919820304,
    105.88468780604738,
];

#[test]
fn the_arm_is_that_of_w1() {
    let expected = [
        8350387.50933227,
        363907.0921935874,
        -1105786.8933914672,
        -132610.04162215575,
        2643206.6050326116,
        -2057982.986354389,
        826177.9888821924,
        -72745.6557338063,
        -355645.94826585706,
        69049.97894329045,
        -399130.18971101625,
        1804840.8822202766,
        679640.8725749606,
        494962.3818354324,
        326855.7000805944,
        1069539.7840695153,
        609009.3783165523,
        405873.7227169382,
        1989109.5806495906,
        -540394.8758830285,
        1029801.1837289344,
    ];
    for name in ["arm", "arm_bowing"] {
        let places = Places::Joints(JOINTS.to_vec());
        let found = answers(name, BenchQuantity::StiffnessAndJacobian, places, &[]);
        assert!(apart(&upper(&found.stiffness), &expected) < 1e-12, "{name}");
        // Drive of joint 1 and its link in the first row; the last link, which turns about the tool's own
        // place, in the second.
        let first = [
            0.13021323613968566,
            0.9982536234101284,
            -0.05907371114590349,
            0.0,
            -0.010502348129696344,
            -0.17747331040181283,
            0.15088903504075188,
            -0.17747331040181283,
        ];
        let last = [
            -0.46531803244288217,
            -0.30673491121275137,
            -0.8302968282047033,
            0.0,
            0.0,
            0.0,
        ];
        if name == "arm" {
            assert!(apart(&found.jacobian[..8], &first) < 1e-12);
            assert!(apart(&found.jacobian[78..84], &last) < 1e-12);
        }
    }
}

#[test]
fn the_hexapod_is_that_of_w2() {
    let expected = [
        16011413.663346339,
        1099216.1903577745,
        -15616237.55601207,
        225849.95194946323,
        3697165.593216249,
        453390.6838524176,
        17726680.425862893,
        -9834438.334807798,
        -3447948.9062744165,
        711816.2677830883,
        -960097.026619832,
        181470352.62663284,
        11101.109178144485,
        -773212.3104385515,
        -937666.2197325509,
        11221619.805134058,
        -67160.17444145796,
        454598.52775426453,
        11087916.953972166,
        442977.3750269382,
        3606306.3057168755,
    ];
    let [x, y, z] = [
        0.04301994148396624,
        -0.21251374597334607,
        -0.03501465221269418,
    ];
    let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::x_axis(), x)
        * nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), y)
        * nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), z);
    let mut pose = turn.matrix().transpose().as_slice().to_vec();
    pose.extend([
        -0.09944419988553015,
        -0.06316547841693607,
        0.9602548930412794,
    ]);
    for name in ["hexapod", "hexapod_bowing"] {
        let places = Places::from_numbers(&pose).expect("a pose");
        let found = answers(name, BenchQuantity::Stiffness, places, &[]);
        assert!(apart(&upper(&found.stiffness), &expected) < 1e-11, "{name}");
    }
}

#[test]
fn the_arm_is_that_of_w3() {
    let places = Places::Joints(JOINTS.to_vec());
    let found = answers(
        "arm",
        BenchQuantity::EquilibriumAndStiffness,
        places,
        &WRENCH,
    );
    let tip = [2.3040364266999003, -0.1326764034643904, 0.5688503861190235];
    assert!(apart(&found.tool[9..], &tip) < 1e-12);
    let drives = [
        -0.0008683997687089613,
        0.0012854956067691401,
        0.0006124628326933333,
        -0.00044324653804612345,
        -0.00029863461837880854,
        -0.0005635082430151703,
    ];
    let own: Vec<f64> = found.coordinates.iter().step_by(7).copied().collect();
    assert!(apart(&own, &drives) < 1e-9);
    // Rows of the moments differ from the columns: the moment is dead, so K_C is not symmetric.
    let moments = [
        2640717.4409789257,
        67504.95661732255,
        490183.01128164586,
        608772.8484777358,
        1986530.696281555,
        -542890.0133621204,
        -2057789.198129245,
        -396255.42563912616,
        328558.23345197685,
        404665.3348651815,
        -542664.072335634,
        1028751.9794254552,
    ];
    assert!(apart(&found.stiffness[24..], &moments) < 1e-10);
}

#[test]
fn the_three_legs_are_those_of_w4() {
    let pose = [
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.07975009900302617,
        0.002038959506585087,
        0.08572386702738674,
    ];
    let wrench = [
        -153.42825326828194,
        -253.3808764697602,
        -47.51739195768261,
        3.4567259917816684,
        9.340102399062985,
        0.9019604164035635,
    ];
    let expected = [
        0.9999972216654975,
        0.00010181639232332719,
        0.00235505726219907,
        -0.0001012793839157683,
        0.999999968846939,
        -0.00022814163897215447,
        -0.0023550804173904476,
        0.00022790248636976983,
        0.9999972008244244,
        0.07967734956642815,
        0.0019515964350442815,
        0.08578305728306747,
    ];
    let places = Places::from_numbers(&pose).expect("a pose");
    let found = answers("puu3", BenchQuantity::Equilibrium, places, &wrench);
    assert!(apart(&found.tool, &expected) < 1e-11);
}

#[test]
fn the_rod_is_that_of_w5() {
    let mut pose = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    pose.extend([1.0, 0.0, 0.0]);
    let places = Places::from_numbers(&pose).expect("a pose");
    let wrench = [0.0, 10.0, 0.0, 0.0, 0.0, 0.0];
    let found = answers("rod", BenchQuantity::Equilibrium, places, &wrench);
    let tip = [0.4450082758724156, 0.8106620357612135, 0.0];
    assert!(apart(&found.tool[9..], &tip) < 1e-10);
    // The default law of links converges to the same rod, faster with the number of pieces: the
    // inextensible elastica has its tip at 0.44500, 0.81061.
    let places = Places::from_numbers(&pose).expect("a pose");
    let bowing = answers("rod_bowing", BenchQuantity::Equilibrium, places, &wrench);
    assert!(apart(&bowing.tool[9..], &tip) < 2e-3);
}

/// Four legs on a platform that three could hold brace each other: their inner forces are known no
/// better than a residual of rounding times their stiffness, and no lane may wait for more.
#[test]
fn legs_that_brace_each_other_are_solved_vectorised() {
    let count = 256;
    for name in ["puu4", "puu4_bowing"] {
        let machine = kinetostat_model::read_model(&model(name)).expect("a model");
        let machine = machine.mechanism;
        let poses = sample::poses(0..count, [0.0; 3], 0.05, 0.0);
        let wrenches: Vec<Wrench> = sample::wrenches(0..count, 300.0, 10.0)
            .chunks(6)
            .map(|w| Wrench(nalgebra::Vector6::from_column_slice(w)))
            .collect();
        let batch = Batch::new(&machine);
        let found = batch
            .equilibrium(&poses, &wrenches, kinetostat::batch::Details::Rest)
            .expect("as many wrenches as poses");
        let vectorised = found.status.iter().filter(|f| **f == Status::Vectorised);
        assert_eq!(vectorised.count(), count, "{name}");
        for i in (0..count).step_by(37) {
            let posture = machine.posture(&poses[i]).expect("reachable");
            let scalar = posture.deflected_by(&wrenches[i]).expect("an equilibrium");
            let own = found.tool_pose(i).translation.vector;
            assert!((own - scalar.tool.translation.vector).norm() < 1e-12);
        }
    }
}

#[test]
fn numbers_that_do_not_fit_are_refused() {
    let open =
        |quantity, places, wrenches: &[f64]| Task::open(&model("arm"), quantity, places, wrenches);
    let joints = || Places::Joints(JOINTS.to_vec());
    let few = open(BenchQuantity::Stiffness, Places::Joints(vec![0.0; 7]), &[]);
    let missing = open(BenchQuantity::Equilibrium, joints(), &[]);
    let needless = open(BenchQuantity::Stiffness, joints(), &WRENCH);
    for refused in [few, missing, needless] {
        assert!(refused.is_err());
    }
    assert!(Places::from_numbers(&[0.0; 11]).is_err());
    assert!(Task::open(&model("none"), BenchQuantity::Stiffness, joints(), &[]).is_err());
}
