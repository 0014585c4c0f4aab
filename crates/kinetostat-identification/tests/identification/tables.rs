//! Tables of measurements: what is read, and how every fault is named.

use kinetostat::number::larger;
use kinetostat_identification::{
    Axes, NoFrame, ReadingOf, TableFault, into_base, observations, places, read_postures,
    read_table,
};
use nalgebra::{Vector3, vector};

use crate::support::h6;

type Outcome = anyhow::Result<()>;

const GRAVITY: Vector3<f64> = vector![0.0, 0.0, -10.0];

fn faults(text: &str) -> Vec<TableFault> {
    let model = h6(false);
    match read_table(text, &Axes::of(&model)) {
        Ok(rows) => observations(&rows, &GRAVITY).err().unwrap_or_default(),
        Err(faults) => faults,
    }
}

const AXES: &str = "A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg";

#[test]
fn decimal_signs_and_separators_are_those_of_the_file() -> Outcome {
    let model = h6(false);
    let axes = Axes::of(&model);
    let points = format!(
        "posture,{AXES},fx_kn,fy_n,fz_n,dx_um,dy_mm,dz_m,note\n# a comment\n1,90,10.5,0,0,0,0,1.5,0,-200,12.5,-0.25,1e-3,\"good, dry\"\n"
    );
    let plain = points.replace("\"good, dry\"", "good");
    let points = plain.clone();
    let quoted = plain.replace("good", "\"good, dry\"");
    let german = points.replace(',', ";").replace('.', ",");
    let tabs = points.replace(',', "\t");
    let mut found = Vec::new();
    for text in [
        &points,
        &german,
        &tabs,
        &quoted,
        &format!("\u{feff}{points}"),
    ] {
        let rows = read_table(text, &axes).map_err(|f| anyhow::anyhow!("{f:?}\n{text}"))?;
        found.push(observations(&rows, &GRAVITY).map_err(|f| anyhow::anyhow!("{f:?}"))?);
    }
    let own = &found[0][0];
    assert_eq!(own.load.force, vector![1500.0, 0.0, -200.0]);
    assert!((own.commands[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    let values: Vec<f64> = own.readings.iter().map(|r| r.value).collect();
    let off = values
        .iter()
        .zip([12.5e-6, -0.25e-3, 1e-3])
        .map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, larger) < 1e-18, "{values:?}");
    for other in &found[1..] {
        assert_eq!(other, &found[0]);
    }
    Ok(())
}

#[test]
fn positions_are_compared_with_those_without_a_load() -> Outcome {
    let model = h6(false);
    let text = format!(
        "posture,{AXES},mass_kg,marker_x_mm,x_mm,y_mm,z_mm,sigma_mm\na,0,0,0,0,0,0,0,50,100,0,200,0.01\na,0,0,0,0,0,0,30,50,100.1,0,199,0.01\na,0,0,0,0,0,0,0,50,100.2,0,200,0.03\n"
    );
    let rows = read_table(&text, &Axes::of(&model)).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    let found = observations(&rows, &GRAVITY).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0].load.force,
        vector![0.0, 0.0, -300.0],
        "30 kg, and down is where the model says"
    );
    let values: Vec<f64> = found[0].readings.iter().map(|r| r.value).collect();
    // Unloaded before and after: their mean.
    let off = values
        .iter()
        .zip([0.0, 0.0, -1e-3])
        .map(|(a, b): (&f64, f64)| (a - b).abs());
    assert!(off.fold(0.0, larger) < 1e-15, "{values:?}");
    // 10 um of the reading, 10 and 30 um of the two unloaded ones.
    let deviation = 1e-5 * (1.0_f64 + (1.0 + 9.0) / 4.0).sqrt();
    assert!((found[0].readings[0].deviation - deviation).abs() < 1e-15);
    assert_eq!(found[0].readings[0].marker.at, vector![0.05, 0.0, 0.0]);
    // For the geometry they are read as they are, with and without the load.
    let found = places(&rows, &GRAVITY).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    let readings = found.iter().flat_map(|o| &o.readings);
    let along_z = readings.filter(|r| r.of == ReadingOf::Place(Vector3::z()));
    let heights: Vec<f64> = along_z.map(|r| r.value).collect();
    assert_eq!(heights, [0.2, 0.199, 0.2]);
    Ok(())
}

#[test]
fn a_gauge_reads_along_its_stylus() -> Outcome {
    let model = h6(false);
    let text =
        format!("{AXES},fz_n,gauge_mm,gauge_x,gauge_y,gauge_z\n0,0,0,0,0,0,-500,0.4,0,0,-2\n");
    let rows = read_table(&text, &Axes::of(&model)).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    let found = observations(&rows, &GRAVITY).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    assert_eq!(
        found[0].readings[0].of,
        ReadingOf::Along(vector![0.0, 0.0, -1.0])
    );
    assert_eq!(found[0].readings.len(), 1);
    Ok(())
}

#[test]
fn all_faults_are_named_with_line_and_column() {
    let text = format!(
        "{AXES},fx_n,dx_mm,dy_mm,dz_mm,sigma_mm\n0,0,0,0,0,0,100,1,2,3,0.1\n0,zero,0,0,0,,100,1,2,3,0.1\n0,0,0,0,0,0,100,1,2,3\n0,0,0,0,0,0,100,1,,3,0\n0,0,0,0,0,0,nan,1,2,3,0.1\n"
    );
    let found = faults(&text);
    let at: Vec<(usize, Option<&str>)> = found
        .iter()
        .map(|f| (f.line, f.column.as_deref()))
        .collect();
    let want = [
        (3, Some("A2_deg")),
        (3, Some("A6_deg")),
        (4, None),
        (5, Some("sigma_mm")),
        (5, None),
        (6, Some("fx_n")),
    ];
    assert_eq!(at, want, "{found:?}");
}

#[test]
fn what_the_header_misses_is_named() {
    let found = faults("A1_deg,A2,A3_mm,fx_n,fx_kn,dx_mm,dy_mm,temperature\n");
    let about = |words: &str| {
        found
            .iter()
            .any(|f| f.message.contains(words) || f.column.as_deref() == Some(words))
    };
    assert!(found.iter().all(|f| f.line == 1));
    for column in ["A2", "A3_mm", "fx_kn", "temperature"] {
        assert!(about(column), "{column}: {found:?}");
    }
    for words in ["A4", "2 of 3"] {
        assert!(about(words), "{words}: {found:?}");
    }
    for empty in [
        "",
        "# nothing\n\n",
        &format!("{AXES},fx_n,dx_mm,dy_mm,dz_mm\n"),
    ] {
        assert_eq!(faults(empty).len(), 1, "{empty:?}");
    }
}

#[test]
fn questions_without_sense_are_asked_back() {
    let head = format!("{AXES},fx_n,dx_mm,dy_mm,dz_mm\n");
    let no_load = faults(&format!("{head}0,0,0,0,0,0,0,1,2,3\n"));
    assert_eq!((no_load.len(), no_load[0].line), (1, 2), "{no_load:?}");
    let positions = format!("{AXES},fx_n,x_mm,y_mm,z_mm\n");
    let no_zero = faults(&format!("{positions}0,0,0,0,0,0,10,1,2,3\n"));
    assert_eq!((no_zero.len(), no_zero[0].line), (1, 2), "{no_zero:?}");
    let only_zero = faults(&format!("{positions}0,0,0,0,0,0,0,1,2,3\n"));
    assert_eq!(only_zero.len(), 1, "{only_zero:?}");
}

#[test]
fn an_instrument_may_stand_anywhere() -> Outcome {
    use kinetostat::PostureRequest;
    use nalgebra::{Rotation3, Vector3};

    let model = h6(false);
    let axes = Axes::of(&model);
    let turn = Rotation3::from_scaled_axis(vector![0.3, -0.2, 2.0]);
    let origin = vector![4.0, -3.0, 1.0];
    let mut random = crate::support::Random::new(8);
    let mut text = format!("posture,{AXES},fz_n,x_m,y_m,z_m\n");
    let shift = vector![1e-4, 2e-4, -1e-3];
    for posture in 0..6 {
        let commands = crate::support::angles(&mut random);
        let place = model
            .mechanism
            .posture(PostureRequest::commands(&commands))?
            .target()
            .translation
            .vector;
        let degrees: Vec<String> = commands
            .iter()
            .map(|q| q.to_degrees().to_string())
            .collect();
        // What the instrument shows of a place in the base, a geometry that is 2 mm wrong included.
        let off = Vector3::from_fn(|_, _| random.between(-2e-3, 2e-3));
        for (force, moved) in [(0.0, Vector3::zeros()), (-500.0, shift)] {
            let shown = turn.inverse() * (place + off + moved - origin);
            text += &format!(
                "{posture},{},{force},{},{},{}\n",
                degrees.join(","),
                shown.x,
                shown.y,
                shown.z
            );
        }
    }
    let mut rows = read_table(&text, &axes).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    let frame = into_base(&mut rows, &model.mechanism)?;
    assert!((frame.origin - origin).norm() < 5e-3, "{frame:?}");
    assert!(frame.left < 3e-3 && frame.places == 6, "{frame:?}");
    let found = observations(&rows, &GRAVITY).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    for observation in &found {
        let moved: Vec<f64> = observation.readings.iter().map(|r| r.value).collect();
        let off = (Vector3::from_column_slice(&moved) - shift).norm();
        assert!(off < 3e-3 * shift.norm(), "{off:e}");
    }
    // Joints of another machine, and one place.
    let mut other = rows.clone();
    other.iter_mut().for_each(|row| row.commands[1] *= -1.5);
    assert!(matches!(
        into_base(&mut other, &model.mechanism),
        Err(NoFrame::OtherMachine { .. })
    ));
    let mut few = rows[..2].to_vec();
    assert!(matches!(
        into_base(&mut few, &model.mechanism),
        Err(NoFrame::TooFew { places: 1 })
    ));
    Ok(())
}

#[test]
fn rows_that_contradict_each_other_are_named() {
    let head = format!("posture,{AXES},fz_n,mass_kg,x_mm,y_mm,z_mm\n");
    let apart = faults(&format!(
        "{head}a,0,0,0,0,0,0,0,0,1,2,3\na,0,0.02,0,0,0,0,-100,0,1,2,3\n"
    ));
    assert_eq!((apart.len(), apart[0].line), (1, 3), "{apart:?}");
    let model = h6(false);
    let text = format!("{head}a,0,0,0,0,0,0,0,0,1,2,3\na,0,0,0,0,0,0,0,30,1,2,3\n");
    let rows = read_table(&text, &Axes::of(&model)).unwrap_or_default();
    let none = observations(&rows, &Vector3::zeros())
        .err()
        .unwrap_or_default();
    assert_eq!(
        none.first().and_then(|f| f.column.as_deref()),
        Some("mass_kg"),
        "{none:?}"
    );
}

#[test]
fn rows_of_a_plan_are_filled_in_one_by_one() {
    let head = format!("posture,{AXES},fz_n,dx_mm,dy_mm,dz_mm\n");
    let model = h6(false);
    let text = format!("{head}1,0,0,0,0,0,0,-100,1,2,3\n2,9,0,0,0,0,0,-100,,,\n");
    let rows = read_table(&text, &Axes::of(&model)).unwrap_or_default();
    assert_eq!(
        observations(&rows, &GRAVITY).map(|found| found.len()),
        Ok(1)
    );
    let empty = faults(&format!("{head}1,0,0,0,0,0,0,-100,,,\n"));
    assert_eq!(empty.len(), 1, "{empty:?}");
}

#[test]
fn postures_need_their_axes_only() -> Outcome {
    let model = h6(false);
    let axes = Axes::of(&model);
    let text = format!("{AXES}\n0,10,0,0,20,0\n5,0,0,0,0,0\n0,10,0,0,20,0\n");
    let found = read_postures(&text, &axes).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    assert_eq!(found.len(), 2, "each posture once");
    assert!((found[0][1] - 10_f64.to_radians()).abs() < 1e-15);
    let without = text.replace(",A6_deg", "").replace(",20,0", ",20");
    assert!(read_postures(&without, &axes).is_err());
    Ok(())
}
