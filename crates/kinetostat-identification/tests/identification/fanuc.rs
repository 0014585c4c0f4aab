//! Cable pulls that were measured on a FANUC R-2000iC, from a table to the report's numbers.

use std::fmt::Write;

use kinetostat_identification::{
    Axes, Finding, FitOptions, Identification, Observation, Theory, Unknowns, identification,
    observations, read_table,
};
use kinetostat_model::Model;
use nalgebra::Vector3;

type Outcome = anyhow::Result<()>;

/// Modified Denavit-Hartenberg rows: alpha and offset of theta in quarter turns, a and d in m.
const GEOMETRY: [[f64; 4]; 6] = [
    [0.0, 0.0, 0.0, 0.67],
    [-1.0, 0.312, -1.0, 0.0],
    [0.0, 1.075, 0.0, 0.0],
    [-1.0, 0.225, 0.0, 1.28],
    [1.0, 0.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0, 0.215],
];

/// The arm as a model file, with rotational springs about x and y at every joint, and about x, y and z at the base, if wanted: a drive is the spring about z.
fn arm(tilts: bool) -> anyhow::Result<Model> {
    let mut elements = String::new();
    let tilt = |elements: &mut String, i: usize| {
        let axes: &[&str] = if i == 0 {
            &["x", "y", "z"]
        } else {
            &["x", "y"]
        };
        for axis in axes.iter().filter(|_| tilts) {
            let _ = writeln!(
                elements,
                "{{ spring = \"revolute\", name = \"tilt {i} {axis}\", axis = \"{axis}\", stiffness_n_m_per_rad = 1e7 }},"
            );
        }
    };
    tilt(&mut elements, 0);
    for (i, [alpha, a, offset, d]) in GEOMETRY.iter().enumerate() {
        let joint = i + 1;
        let _ = writeln!(
            elements,
            "{{ rigid = {{ translation_m = [{a:?}, 0, 0], rotation_vector_deg = [{:?}, 0, 0] }} }},\n{{ rigid = {{ rotation_vector_deg = [0, 0, {:?}] }} }},\n{{ actuator = \"revolute\", name = \"A{joint}\", axis = \"z\", stiffness_n_m_per_rad = 1e6 }},\n{{ rigid = {{ translation_m = [0, 0, {d:?}] }} }},",
            90.0 * alpha,
            90.0 * offset
        );
        tilt(&mut elements, joint);
    }
    let text = format!(
        "schema = 1\n[mechanism]\nname = \"FANUC\"\ngravity_m_per_s2 = [0, 0, 0]\n[[platform]]\nname = \"tool\"\nhome = {{ position_m = [1.8, 0, 1.97], x_axis = \"-z\", y_axis = \"-y\" }}\n[chain.arm]\nelements = [\n{elements}]\n[[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n"
    );
    Ok(Model::from_toml(&text, "fanuc.toml")?)
}

/// The pulls as a table with the model's angles; none, said plainly, where the data are not there.
fn table() -> Option<String> {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/identification/fanuc_r2000ic_cable_pulls.csv"
    );
    let Ok(text) = std::fs::read_to_string(file) else {
        eprintln!("skipped: {file} is not there");
        return None;
    };
    let mut out = String::from(
        "A1_rad,A2_rad,A3_rad,A4_rad,A5_rad,A6_rad,fx_n,fy_n,fz_n,load_x_m,load_y_m,load_z_m,marker_x_m,marker_y_m,marker_z_m,dx_m,dy_m,dz_m\n",
    );
    for line in text.lines().skip(1) {
        let v: Vec<f64> = line
            .split(',')
            .filter_map(|cell| cell.parse().ok())
            .collect();
        assert_eq!(v.len(), 12, "{line}");
        let angles = [v[0], v[1], -(v[1] + v[2]), -v[3], -v[4], -v[5]];
        let angles: Vec<String> = angles.iter().map(ToString::to_string).collect();
        let rest: Vec<String> = v[6..].iter().map(ToString::to_string).collect();
        let tool = "0.0069,0.2453,0.3193";
        let _ = writeln!(
            out,
            "{},{},{tool},{tool},{}",
            angles.join(","),
            rest[..3].join(","),
            rest[3..].join(",")
        );
    }
    Some(out)
}

const OPTIONS: FitOptions = FitOptions {
    theory: Theory::SmallLoads,
    robust: false,
    prior: None,
};

fn question(tilts: bool) -> anyhow::Result<Option<(Unknowns, Vec<Observation>)>> {
    let Some(text) = table() else { return Ok(None) };
    let model = arm(tilts)?;
    let rows =
        read_table(&text, &Axes::of(&model)).map_err(|faults| anyhow::anyhow!("{faults:?}"))?;
    let observations =
        observations(&rows, &Vector3::zeros()).map_err(|faults| anyhow::anyhow!("{faults:?}"))?;
    let patterns: &[&str] = match tilts {
        true => &["joints", "chain.arm.tilt*"],
        false => &["joints"],
    };
    Ok(Some((Unknowns::matching(&model, patterns)?, observations)))
}

fn identified(tilts: bool) -> anyhow::Result<Option<Identification>> {
    let found = question(tilts)?.map(|(unknowns, o)| identification(&unknowns, &o, &OPTIONS));
    Ok(found.transpose()?)
}

#[test]
fn joints_are_those_of_the_reference_and_the_last_is_weakly_known() -> Outcome {
    let Some(found) = identified(false)? else {
        return Ok(());
    };
    let stiffnesses = [0.861, 2.720, 1.960, 0.271, 0.425, 0.206];
    let deviations = [3.4, 12.0, 9.0, 21.0, 13.0, 73.0];
    for ((number, stiffness), deviation) in found.numbers.iter().zip(stiffnesses).zip(deviations) {
        let found = number.identified.unwrap_or(f64::NAN) * 1e-6;
        assert!(
            (found - stiffness).abs() < 6e-4,
            "{}: {found}",
            number.number
        );
        let percent = number.deviation_percent.unwrap_or(f64::NAN);
        assert!(
            (percent - deviation).abs() < 0.51,
            "{}: {percent} %",
            number.number
        );
    }
    assert!(
        (found.rms_after_mm - 0.215).abs() < 5e-4,
        "{}",
        found.rms_after_mm
    );
    assert!(
        found
            .rms_left_out_mm
            .is_some_and(|rms| (rms - 0.234).abs() < 5e-4),
        "{:?}",
        found.rms_left_out_mm
    );
    let weak = |f: &Finding| matches!(f, Finding::Weak { number, .. } if number.contains(".A6."));
    assert!(found.findings.iter().any(weak), "{:?}", found.findings);
    Ok(())
}

#[test]
fn tilts_of_joints_and_base_explain_more() -> Outcome {
    let Some(found) = identified(true)? else {
        return Ok(());
    };
    assert_eq!((found.numbers.len(), found.rank), (21, 17));
    assert!(
        (found.rms_after_mm - 0.158).abs() < 5e-4,
        "{}",
        found.rms_after_mm
    );
    assert!(
        found.rms_left_out_mm.is_some_and(|rms| rms < 0.180),
        "{:?}",
        found.rms_left_out_mm
    );
    let rigid = found
        .findings
        .iter()
        .filter(|f| matches!(f, Finding::Rigid { .. }))
        .count();
    assert!(rigid > 0, "{:?}", found.findings);
    Ok(())
}

#[test]
fn resampled_postures_scatter_as_the_covariance_by_postures_says() -> Outcome {
    let Some((unknowns, observations)) = question(false)? else {
        return Ok(());
    };
    let found = identification(&unknowns, &observations, &OPTIONS)?;
    let resampled = found.clone().with_resampled_intervals(&unknowns, 2000);
    assert!(resampled.resamples > 1990, "{}", resampled.resamples);
    let again = found.clone().with_resampled_intervals(&unknowns, 2000);
    // Width of an interval of compliances; the last joint may be rigid.
    let width = |of: &Identification, k: usize| match of.numbers[k].interval {
        Some([Some(low), Some(high)]) => 1.0 / low - 1.0 / high,
        _ => f64::NAN,
    };
    for k in 0..5 {
        let ratio = width(&resampled, k) / width(&found, k);
        assert!((0.8..1.1).contains(&ratio), "{k}: {ratio}");
        assert_eq!(resampled.numbers[k].interval, again.numbers[k].interval);
    }
    Ok(())
}
