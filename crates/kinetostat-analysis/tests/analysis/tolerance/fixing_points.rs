//! A hexapod whose legs are fixed elsewhere than drawn, against its kinematics alone: the unloaded tool is where the six commanded lengths
//! fit between the points as they are.

use kinetostat::nalgebra::{Matrix6, Point3, UnitQuaternion, Vector3, Vector6};
use kinetostat::{Pose, Wrench};
use kinetostat_analysis::tolerance::{
    DependsOnMachine, Quantity, Room, UncertainMachine, UncertaintyFile,
};
use kinetostat_model::Model;

/// Points of the legs, m: on the base, and on the platform in the axes of the tool.
struct Legs {
    base: [Vector3<f64>; 6],
    platform: [Vector3<f64>; 6],
}

impl Legs {
    /// As the file of the model says.
    fn of(text: &str) -> Self {
        let model: toml::Table = toml::from_str(text).expect("TOML");
        let limbs = model["limb"].as_array().expect("limbs");
        let point = |i: usize, end: &str| {
            let at = limbs[i][end]["position_mm"].as_array().expect("a point");
            Vector3::from_fn(|k, _| match &at[k] {
                toml::Value::Integer(n) => 1e-3 * *n as f64,
                other => 1e-3 * other.as_float().expect("a number"),
            })
        };
        Self {
            base: std::array::from_fn(|i| point(i, "start")),
            platform: std::array::from_fn(|i| point(i, "end")),
        }
    }

    fn lengths(&self, pose: &Pose) -> Vector6<f64> {
        Vector6::from_fn(|i, _| {
            let end = pose * Point3::from(self.platform[i]);
            (end.coords - self.base[i]).norm()
        })
    }

    /// Where the lengths fit, by Newton's method with differences, from a pose near it.
    fn pose(&self, lengths: &Vector6<f64>, near: &Pose) -> Pose {
        let moved = |pose: &Pose, by: &Vector6<f64>| {
            let (way, turn) = (by.fixed_rows::<3>(0), by.fixed_rows::<3>(3));
            Pose::from_parts(
                (pose.translation.vector + way).into(),
                UnitQuaternion::from_scaled_axis(turn.into_owned()) * pose.rotation,
            )
        };
        let mut pose = *near;
        for _ in 0..20 {
            let step = 1e-6;
            let columns: Vec<Vector6<f64>> = (0..6)
                .map(|k| {
                    let by = Vector6::from_fn(|i, _| if i == k { step } else { 0.0 });
                    (self.lengths(&moved(&pose, &by)) - self.lengths(&moved(&pose, &-by)))
                        / (2.0 * step)
                })
                .collect();
            let away = lengths - self.lengths(&pose);
            let by = Matrix6::from_columns(&columns).lu().solve(&away);
            pose = moved(&pose, &by.expect("a regular posture"));
        }
        assert!((lengths - self.lengths(&pose)).norm() < 1e-13);
        pose
    }
}

#[test]
fn a_hexapod_with_points_off_is_where_its_leg_lengths_fit() {
    let text = kinetostat_model::preset_text("cubic_hexapod").expect("a preset");
    // Without weight the unloaded legs have their commanded lengths.
    let text = text.replace(
        "gravity_m_per_s2 = [0, 0, -9.81]",
        "gravity_m_per_s2 = [0, 0, 0]",
    );
    let drawn = Model::from_toml(&text, "hexapod.toml").expect("a model");
    let names = [
        "limb.leg 1.start.position_mm.x",
        "limb.leg 2.start.position_mm.z",
        "limb.leg 3.end.position_mm.y",
        "limb.leg 4.end.position_mm.x",
        "limb.leg 5.end.position_mm.z",
    ];
    let rows = names.map(|name| format!("[[uncertain]]\nparameter = \"{name}\"\nnormal = 1\n"));
    let spread = format!("schema = 1\n{}", rows.concat());
    let file = UncertaintyFile::read(&spread, "spread.toml", &drawn, &Wrench::zero());
    let file = file.expect("a file");
    let home = drawn.mechanism.platforms()[drawn.mechanism.tool()].home;
    let turn = UnitQuaternion::from_euler_angles(0.03, -0.05, 0.02);
    let places = [(0.02, -0.03, 0.01), (-0.05, 0.04, -0.03)].map(|(x, y, z)| {
        let position = home.translation.vector + Vector3::new(x, y, z);
        Pose::from_parts(position.into(), turn * home.rotation)
    });
    let asked = [Quantity::Error];
    let machine = UncertainMachine::new(
        &drawn,
        &Pose::identity(),
        &file,
        &places,
        Wrench::zero(),
        &asked,
    )
    .expect("a machine");
    let off_mm = [0.7, -1.3, 0.9, -2.1, 1.6];
    let nominal = file.uncertainties.nominal();
    let values: Vec<f64> = nominal.iter().zip(off_mm).map(|(x, d)| x + d).collect();
    let mut out = vec![f64::NAN; machine.width()];
    machine
        .answer(&values, &mut Room::default(), &mut out)
        .expect("an answer");
    let legs = Legs::of(&text);
    let mut built = Legs::of(&text);
    built.base[0].x += 0.7e-3;
    built.base[1].z -= 1.3e-3;
    built.platform[2].y += 0.9e-3;
    built.platform[3].x -= 2.1e-3;
    built.platform[4].z += 1.6e-3;
    for (place, row) in places.iter().zip(out.chunks_exact(4)) {
        let found = built.pose(&legs.lengths(place), place);
        let exact = 1e3 * (found.translation.vector - place.translation.vector);
        assert!(exact.norm() > 0.5, "the test asks for nothing");
        let off = Vector3::new(row[1], row[2], row[3]) - exact;
        assert!(off.norm() < 1e-8, "{row:?} instead of {exact}");
    }
}
