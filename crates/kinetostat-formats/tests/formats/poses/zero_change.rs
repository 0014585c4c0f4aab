//! Both kinds of lists are read, and without pieces every byte comes back.

use kinetostat_formats::*;
use nalgebra::{Isometry3, Rotation3, UnitQuaternion, Vector3};

use super::{RASTERS, TABLE, place, program, read_with, written};

#[test]
fn every_byte_comes_back_with_any_line_ending() {
    for (name, text) in [
        ("a.csv", TABLE),
        ("a.yaml", RASTERS),
        ("a", TABLE),
        ("a", RASTERS),
    ] {
        for bytes in [
            text.as_bytes().to_vec(),
            text.replace('\n', "\r\n").into_bytes(),
            text.trim_end().as_bytes().to_vec(),
            [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            [text.as_bytes(), b"# \xff\xfe\n\n"].concat(),
        ] {
            let program = read_with(name, &bytes, &ReadOptions::default())
                .unwrap_or_else(|errors| panic!("{errors:#?}"));
            let files = write(&program, &[], &WriteOptions::default()).unwrap();
            assert!(files == [(name.to_owned(), bytes)]);
        }
    }
}

/// As spreadsheets in German write it: each number is read, and corrected ones have commas again.
#[test]
fn decimal_commas_are_read_and_written_again() {
    let text = "x_mm;y_mm;z_mm;note\r\n1200,5;-0,25;9e2;a, b.c\r\n1,5e3;1;900,125;1\r\n";
    let own = program("de.csv", text);
    assert_eq!(place(&own, 0), [1200.5, -0.25, 900.0]);
    assert_eq!(place(&own, 1), [1500.0, 1.0, 900.125]);
    assert_eq!(written(&own, &[]), text);
    let pose = own.motions[1].target.pose().unwrap().clone();
    let moved = Piece::to(1, pose.position_mm + Vector3::new(0.5, 0.25, 0.0));
    let corrected = text.replace("1,5e3;1;900,125", "1500,500;1,250;900,125");
    assert_eq!(written(&own, &[moved]), corrected);
    // Whether a point stands behind thousands is not known then.
    let both = text.replace("9e2", "900.125");
    assert!(read_with("de.csv", both.as_bytes(), &ReadOptions::default()).is_err());
}

#[test]
fn columns_are_what_their_names_say() {
    let program = program("slot.csv", TABLE);
    let kinds: Vec<&MotionKind> = program.motions.iter().map(|motion| &motion.kind).collect();
    let (joint, linear) = (&MotionKind::Joint, &MotionKind::Linear);
    assert_eq!(kinds, [joint, linear, linear, joint]);
    assert_eq!(place(&program, 2), [60.0, 0.0, -1.0]);
    let second = &program.motions[1];
    assert_eq!((second.line, second.speed.mm_per_s), (5, Some(20.0)));
    assert_eq!(
        (second.tool.name.as_str(), second.work_object.name.as_str()),
        ("tMill", "wPart")
    );
    assert_eq!(second.follows, Some(0));
    assert_eq!(program.motions[0].speed.mm_per_s, None);
    assert_eq!(second.target.pose().unwrap().external, [None]);
    let q = second.target.pose().unwrap().orientation;
    assert!((q * Vector3::z() + Vector3::z()).norm() < 1e-12);
    assert_eq!(
        program.findings[0].message,
        "columns that are carried as they are: note, seen"
    );
    let mut options = ReadOptions::default();
    options
        .frames
        .insert("WPART".into(), Isometry3::translation(1000.0, 0.0, 0.0));
    let placed = read_with("slot.csv", TABLE.as_bytes(), &options).unwrap();
    assert_eq!(placed.motions[2].base_pose().unwrap().translation.x, 1060.0);
}

#[test]
fn orders_separators_and_conventions_of_columns_do_not_matter() {
    // About x by 10, then y by 20, then z by 30 deg, all fixed; the matrices are multiplied here.
    let about = |axis: Vector3<f64>, deg: f64| {
        Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), f64::to_radians(deg))
    };
    let matrix = about(Vector3::z(), 30.0) * about(Vector3::y(), 20.0) * about(Vector3::x(), 10.0);
    let wanted = UnitQuaternion::from_rotation_matrix(&matrix);
    let q = wanted.quaternion();
    for text in [
        "z_m;rx_deg;ry_deg;rz_deg;x_m;y_m\n0.3;10;20;30;0.1;0.2\n".to_owned(),
        "x_mm\tc_deg\tb_deg\ta_deg\tz_mm\ty_mm\n100\t10\t20\t30\t300\t200\n".to_owned(),
        "X_MM, Roll_deg, Pitch_deg, Yaw_deg, Y_MM, Z_MM\r\n 100, 10, 20, 30, 200, 300\r\n"
            .to_owned(),
        format!(
            "x_mm,y_mm,z_mm,qz,qy,qx,qw\n100,200,300,{},{},{},{}\n",
            q.k, q.j, q.i, q.w
        ),
        format!(
            "\"x_mm\",\"y_mm\",\"z_mm\",qz,qy,qx,qw\n\"1e2\",200,300,{},{},{},{}\n",
            q.k, q.j, q.i, q.w
        ),
    ] {
        let program = program("a.csv", &text);
        let pose = program.motions[0].target.pose().unwrap();
        assert!(
            (pose.position_mm - Vector3::new(100.0, 200.0, 300.0)).norm() < 1e-12,
            "{text}"
        );
        assert!(pose.orientation.angle_to(&wanted) < 1e-12, "{text}");
    }
    let text = "x_mm,y_mm,z_mm,i,j,k\n1,2,3,0,0,1\n";
    let axis = program("a.csv", text).motions[0]
        .target
        .pose()
        .unwrap()
        .orientation;
    assert_eq!(axis, UnitQuaternion::identity());
}

#[test]
fn rasters_begin_in_air() {
    let program = program("a.yaml", RASTERS);
    let kinds: Vec<bool> = (program.motions.iter())
        .map(|motion| motion.kind == MotionKind::Joint)
        .collect();
    assert_eq!(kinds, [true, false, true]);
    assert_eq!(program.motions[1].line, 17);
    for (motion, wanted) in [
        [100.0, 250.0, -20.0],
        [100.0, 300.0, -20.0],
        [200.0, 350.0, -20.0],
    ]
    .iter()
    .enumerate()
    {
        let off = Vector3::from(place(&program, motion)) - Vector3::from(*wanted);
        assert!(off.norm() < 1e-9, "{motion}");
        let q = program.motions[motion].target.pose().unwrap().orientation;
        assert!((q * Vector3::z() + Vector3::z()).norm() < 1e-12);
    }
    let said: Vec<&str> = (program.findings.iter())
        .map(|finding| finding.message.as_str())
        .collect();
    assert!(
        said[0].starts_with("no unit of lengths is stated: taken as metres"),
        "{said:?}"
    );
    assert!(
        said[1].contains("`tool_offset` is a pose in no list"),
        "{said:?}"
    );
    // The same in a table.
    let text = "raster,x_mm,y_mm,z_mm\n1,0,0,0\n1,1,0,0\n2,1,1,0\n2,0,1,0\n";
    let table = super::program("a.csv", text);
    let air: Vec<bool> = (table.motions.iter())
        .map(|motion| motion.kind == MotionKind::Joint)
        .collect();
    assert_eq!(air, [true, false, true, false]);
}

#[test]
fn other_ways_to_write_yaml_are_the_same() {
    let mut options = ReadOptions::default();
    options.length_unit = Some(LengthUnit::Metre);
    for text in [
        "- position: {x: 0.1, y: 0.2, z: 0.3}\n- position: {x: 0.4, y: 0.2, z: 0.3}\n",
        "poses:\n- [0.1, 0.2, 0.3]\n- [0.4, 0.2, 0.3]\n",
        "%YAML 1.2\n---\nposes: [[0.1, 0.2, 0.3], [0.4, 0.2, 0.3]]\n...\n",
        "- header: {frame_id: part}\n  pose:\n    position:\n      x: 0.1\n      y: 0.2\n      z: 0.3\n    orientation: {x: 0, y: 0, z: 0, w: 1}\n- pose:\n    position: [0.4, 0.2, 0.3]\n",
        "- {x_m: 0.1, y_m: 0.2, z_m: 0.3}\n- {x_m: 0.4, y_m: 0.2, z_m: 0.3, speed_mm_per_s: 20}\n",
        "- position:\n    x: 0.1\n    y: 0.2\n    z: 0.3\n-\n  position:\n    x: 0.4\n    y: 0.2\n    z: 0.3\n",
    ] {
        let program = read_with("a.yml", text.as_bytes(), &options)
            .unwrap_or_else(|errors| panic!("{text}: {errors:#?}"));
        assert_eq!(program.motions.len(), 2, "{text}");
        assert_eq!(place(&program, 0), [100.0, 200.0, 300.0], "{text}");
        assert_eq!(place(&program, 1), [400.0, 200.0, 300.0], "{text}");
        let files = write(&program, &[], &WriteOptions::default()).unwrap();
        assert_eq!(files[0].1, text.as_bytes());
        // A further pose before the second one is found again, or refused in words.
        let between = Vector3::new(250.0, 200.0, 301.0);
        let end = Vector3::new(400.0, 200.0, 300.5);
        let pieces = [Piece::to(1, between), Piece::to(1, end)];
        match write(&program, &pieces, &WriteOptions::default()) {
            Ok(files) => {
                let again = read_with("a.yml", &files[0].1, &options)
                    .unwrap_or_else(|errors| panic!("{text}: {errors:#?}"));
                assert_eq!(again.motions.len(), 3, "{text}");
                for (motion, wanted) in [(1, between), (2, end)] {
                    let off = Vector3::from(place(&again, motion)) - wanted;
                    assert!(off.norm() < 1e-6, "{text}: {off}");
                }
            }
            Err(error) => {
                assert!(
                    text.contains("[[") || text.contains("-\n"),
                    "{text}: {error}"
                );
                assert!(
                    error.to_string().contains("not stand on lines of its own"),
                    "{error}"
                );
            }
        }
    }
}

#[test]
fn joint_values_are_read() {
    let text = "joint_2_deg,joint_1_rad,joint_3_mm\n10,0.5,7\n20,1,8\n";
    let program = program("a.csv", text);
    let Target::Joints { values_deg } = &program.motions[1].target else {
        panic!("{:?}", program.motions[1].target)
    };
    assert!((values_deg[0] - 180.0 / std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(values_deg[1..], [20.0, 8.0]);
    let named = super::program("a.csv", "shoulder_deg,elbow_deg,note\n1,2,x\n");
    let Target::Joints { values_deg } = &named.motions[0].target else {
        panic!()
    };
    assert_eq!(values_deg[..], [1.0, 2.0]);
    let moved = [Piece::to(0, Vector3::zeros())];
    let error = write(&program, &moved, &WriteOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("line 2: the motion has no pose"),
        "{error}"
    );
}

#[test]
fn files_are_recognised() {
    for (name, text, language) in [
        ("a.csv", "x_mm,y_mm,z_mm\n", Some(Language::Poses)),
        ("A.YAML", RASTERS, Some(Language::Poses)),
        ("a.ngc", "G1 X1\n", None),
    ] {
        assert_eq!(language_of(name, text.as_bytes()), language);
    }
}
