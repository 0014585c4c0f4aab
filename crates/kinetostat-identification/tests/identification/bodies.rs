//! Loads and markers on other bodies than the tool.

use kinetostat_identification::{
    Axes, Body, BodyPoint, FitOptions, Knowledge, Observation, Reading, TestLoad, Theory, Unknowns,
    identification, identify, observations, predict, read_table,
};
use kinetostat_model::Model;
use kinetostat_testing::Worst;
use nalgebra::{DVector, Vector3, vector};

use crate::support::{FLANGE, H6, JOINTS, Random, TOOL, angles, arm, asked, read, worst};

type Outcome = anyhow::Result<()>;

/// Node of arm H6 at joint 4, which joint 3 moves.
const ELBOW: &str = "elbow";

fn with_elbow(compliances: &[f64], weights: bool) -> Model {
    let behind = |joints: usize| match joints {
        3 => format!("  {{ node = \"{ELBOW}\" }},\n"),
        _ => String::new(),
    };
    arm(&JOINTS, FLANGE, compliances, weights, &behind)
}

fn elbow(model: &Model, at: Vector3<f64>) -> anyhow::Result<BodyPoint> {
    let on = Body::named(&model.mechanism, ELBOW).map_err(anyhow::Error::msg)?;
    Ok(BodyPoint { on, at })
}

/// Displacement and turn, and for loaded equilibria the place.
fn readings(marker: BodyPoint, theory: Theory) -> Vec<Reading> {
    let zero = Vector3::zeros();
    let mut readings: Vec<Reading> = Reading::displacement(marker, &zero, 1e-5).into();
    readings.extend(Reading::turn(marker.on, &zero, 1e-5));
    if theory == Theory::Loaded {
        readings.extend(Reading::place(marker, &zero, 1e-5));
    }
    readings
}

#[test]
fn the_elbow_moves_as_the_tool_of_the_arm_that_ends_there() -> Outcome {
    let whole = with_elbow(&H6, false);
    let short = arm(&JOINTS[..3], JOINTS[3].1, &H6[..3], false, &|_| {
        String::new()
    });
    let (of_whole, of_short) = (
        Unknowns::matching(&whole, &["joints"])?,
        Unknowns::matching(&short, &["joints"])?,
    );
    let mut random = Random::new(7);
    for theory in [Theory::SmallLoads, Theory::Loaded] {
        for i in 0..5 {
            let commands = angles(&mut random);
            let (load_at, marker) = (random.vector(0.3), random.vector(0.3));
            let mut load = TestLoad::force_at(load_at, random.vector(7000.0));
            load.moment = random.vector(2000.0);
            let short_commands = commands[..3].to_vec();
            let own = asked(i, short_commands, load, readings(marker.into(), theory));
            let wanted = predict(&of_short, &of_short.nominal(), &[own], theory)?;
            load.at = elbow(&whole, load_at)?;
            let own = asked(i, commands, load, readings(elbow(&whole, marker)?, theory));
            let found = predict(&of_whole, &of_whole.nominal(), &[own], theory)?;
            let size = wanted[0].values.rows(0, 6).norm();
            let off = (&found[0].values - &wanted[0].values).norm();
            assert!(off < 1e-9 * size, "{theory:?}: {off:e} of {size:e}");
            let slopes = &wanted[0].derivatives;
            let off = (found[0].derivatives.columns(0, 3) - slopes).norm();
            assert!(off < 1e-8 * slopes.norm(), "{theory:?}: {off:e}");
            let beyond = found[0].derivatives.columns(3, 3).norm();
            assert!(beyond < 1e-9 * slopes.norm(), "{theory:?}: {beyond:e}");
        }
    }
    Ok(())
}

#[test]
fn a_limb_that_starts_on_a_platform_carries_its_nodes_along() -> Outcome {
    // The same crane as one chain, and as a rail with a boom on its carriage.
    let rail = r#"{ actuator = "prismatic", name = "trolley", axis = "x", stiffness_n_per_m = 1e6 },
  { actuator = "revolute", name = "slew", axis = "z", stiffness_n_m_per_rad = 3e5 },
"#;
    let boom = r#"{ rigid = { translation_m = [0.0, 0.0, 0.4] } },
  { actuator = "revolute", name = "luff", axis = "y", stiffness_n_m_per_rad = 2e5 },
  { rigid = { translation_m = [0.5, 0.1, 0.0] }, name = "to the knee" },
  { node = "knee" },
  { actuator = "prismatic", name = "reach", axis = "x", stiffness_n_per_m = 4e6 },
"#;
    let head = |carriage: &str| {
        format!(
            "schema = 1\n[mechanism]\nname = \"crane\"\ngravity_m_per_s2 = [0, 0, 0]\n{carriage}[[platform]]\nname = \"hook\"\nhome = {{ position_m = [0.5, 0.1, 0.4] }}\n"
        )
    };
    let limb = |from: &str, to: &str, elements: &str, name: &str| {
        format!(
            "[chain.{name}]\nelements = [\n  {elements}]\n[[limb]]\nname = \"{name}\"\nfrom = \"{from}\"\nto = \"{to}\"\nchain = \"{name}\"\n"
        )
    };
    let one = head("") + &limb("base", "hook", &format!("{rail}  {boom}"), "crane");
    let two = head("[[platform]]\nname = \"carriage\"\nhome = { position_m = [0, 0, 0] }\n")
        + &limb("base", "carriage", rail, "rail")
        + &limb("carriage", "hook", boom, "boom");
    let mut found = Vec::new();
    for text in [one, two] {
        let model = Model::from_toml(&text, "crane.toml")?;
        let on = Body::named(&model.mechanism, "knee").map_err(anyhow::Error::msg)?;
        let mut random = Random::new(5);
        let mut own = Vec::new();
        for theory in [Theory::SmallLoads, Theory::Loaded] {
            let load = TestLoad {
                force: random.vector(4000.0),
                moment: random.vector(900.0),
                at: BodyPoint {
                    on,
                    at: random.vector(0.2),
                },
            };
            let marker = BodyPoint {
                on,
                at: random.vector(0.2),
            };
            let commands = vec![0.3, 0.5, -0.4, 0.2];
            let asked = asked(0, commands, load, readings(marker, theory));
            let unknowns = Unknowns::matching(&model, &["joints"])?;
            let mut shown = predict(&unknowns, &unknowns.nominal(), &[asked], theory)?;
            // Limbs stand in the order of their names.
            let joints = ["trolley", "slew", "luff", "reach"].map(|joint| {
                let list = unknowns.list().iter();
                let at = list.map(|u| u.parameter.path.contains(joint));
                at.into_iter().position(|own| own).unwrap_or(usize::MAX)
            });
            shown[0].derivatives = shown[0].derivatives.select_columns(&joints);
            own.extend(shown);
        }
        found.push(own);
    }
    for (one, two) in found[0].iter().zip(&found[1]) {
        let off = (&one.values - &two.values).norm() / one.values.norm();
        assert!(off < 1e-9, "{off:e}");
        let off = (&one.derivatives - &two.derivatives).norm() / one.derivatives.norm();
        assert!(off < 1e-8, "{off:e}");
    }
    Ok(())
}

#[test]
fn derivatives_by_springs_and_geometry_are_those_of_differences() -> Outcome {
    let model = with_elbow(&H6, true);
    let mut random = Random::new(23);
    let load = TestLoad::force_at(elbow(&model, random.vector(0.3))?, random.vector(6000.0));
    let mut all = readings(elbow(&model, random.vector(0.3))?, Theory::Loaded);
    all.extend(readings(TOOL.into(), Theory::Loaded));
    let observations = [asked(0, angles(&mut random), load, all)];
    let unknowns =
        Unknowns::matching(&model, &["joints", "geometry"])?.with_markers(&observations, 1e-3);
    assert!(
        unknowns
            .list()
            .iter()
            .any(|u| u.parameter.path == "marker 2.z")
    );
    let at = unknowns.nominal();
    let found = predict(&unknowns, &at, &observations, Theory::Loaded)?;
    let moves = found[0].values.rows(0, 6).norm();
    let mut off = Worst::default();
    for (k, size) in unknowns.sizes().iter().enumerate() {
        let step = 1e-3 * size;
        let moved = |sign: f64| {
            let mut values: DVector<f64> = at.clone();
            values[k] += sign * step;
            predict(&unknowns, &values, &observations, Theory::Loaded)
        };
        let difference = (&moved(1.0)?[0].values - &moved(-1.0)?[0].values) / (2.0 * step);
        let own = found[0].derivatives.column(k);
        // In units of the numbers' sizes; joint 6 moves neither node nor centres of mass.
        off.add((own - &difference).norm() * size / moves);
    }
    assert!(off.value() < 1e-5, "{:e}", off.value());
    Ok(())
}

#[test]
fn loads_on_the_forearm_show_the_joints_before_it() -> Outcome {
    let model = with_elbow(&H6, true);
    let unknowns = Unknowns::matching(&model, &["joints"])?;
    let mut random = Random::new(41);
    let mut pulls: Vec<Observation> = Vec::new();
    for i in 0..12 {
        let load = TestLoad::force_at(
            elbow(&model, vector![0.0, 0.1, 0.0])?,
            random.vector(4000.0),
        );
        let zero = Vector3::zeros();
        let marker = Reading::displacement(elbow(&model, vector![0.1, 0.0, 0.2])?, &zero, 2e-5);
        pulls.push(asked(i, angles(&mut random), load, marker.into()));
    }
    read(&unknowns, &mut pulls, Theory::Loaded, |_| 0.0)?;
    let softer: Vec<f64> = H6.iter().map(|c| 1.3 * c).collect();
    let softer = with_elbow(&softer, true);
    let start = Unknowns::matching(&softer, &["joints"])?;
    let options = FitOptions {
        theory: Theory::Loaded,
        robust: false,
        prior: None,
    };
    let found = identify(&start, &pulls, &options)?;
    let off = worst(&found.linear.estimate.as_slice()[..3], &H6[..3]);
    assert!(off < 1e-8, "{off:e}");
    let answer = identification(&start, &pulls, &options)?;
    let known: Vec<Knowledge> = answer.numbers.iter().map(|n| n.knowledge).collect();
    assert_eq!(known[3..], [Knowledge::Unseen; 3]);
    Ok(())
}

#[test]
fn a_table_names_nodes() -> Outcome {
    let model = with_elbow(&H6, false);
    let head = "A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg,fz_n,load_on,load_x_mm,marker_on,marker_z_mm,dx_mm,dy_mm,dz_mm\n";
    let rows = format!(
        "{head}0,0,0,0,0,0,-900,{ELBOW},50,,20,0,0,-1\n0,0,0,0,0,0,-900,,50,elbow,0,0,0,-1\n"
    );
    let axes = Axes::of(&model);
    let found = read_table(&rows, &axes).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    assert_eq!(found[0].load.at, elbow(&model, vector![0.05, 0.0, 0.0])?);
    assert_eq!(found[0].marker, vector![0.0, 0.0, 0.02].into());
    assert_eq!(found[1].load.at, vector![0.05, 0.0, 0.0].into());
    assert_ne!(found[1].marker.on, Body::Tool);
    let made = observations(&found, &Vector3::zeros()).map_err(|f| anyhow::anyhow!("{f:?}"))?;
    assert_eq!(made.len(), 2, "another body is another load");
    let faults = read_table(&rows.replace(",elbow,50", ",shoulder,50"), &axes)
        .err()
        .unwrap_or_default();
    assert_eq!(faults.len(), 1);
    let own = (
        faults[0].line,
        faults[0].column.as_deref(),
        faults[0].found.as_deref(),
    );
    assert_eq!(own, (2, Some("load_on"), Some("shoulder")));
    assert!(faults[0].message.contains(ELBOW), "{}", faults[0].message);
    let none = Body::named(&model.mechanism, "leg:tip")
        .err()
        .unwrap_or_default();
    assert!(none.contains("arm"), "{none}");
    Ok(())
}
