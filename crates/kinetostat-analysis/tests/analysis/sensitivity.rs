//! Derivatives by the numbers of model files against differences of machines that are solved anew.

use kinetostat::nalgebra::Vector3;
use kinetostat::{Pose, Wrench};
use kinetostat_analysis::sensitivity::{CommandedPlace, SensitivityTask, Values, sensitivities};
use kinetostat_model::{Model, ParameterKind};

/// Relative difference, beside what 1 % of a number could do at most.
fn apart(found: f64, by_differences: f64, least: f64) -> f64 {
    (found - by_differences).abs() / found.abs().max(by_differences.abs()).max(least)
}

fn compared(name: &str, model: &Model, moved: [f64; 3], wrench: Wrench, tool: Pose) -> usize {
    let mechanism = model.mechanism.with_tool(&tool);
    let home = mechanism.platforms()[mechanism.tool()].home;
    let target = Pose::from_parts(
        (home.translation.vector + Vector3::new(moved[0], moved[1], moved[2])).into(),
        home.rotation,
    );
    let direction = Wrench::new(Vector3::new(0.36, -0.48, 0.8), Vector3::new(0.0, 0.0, 0.0));
    let place = match mechanism.turns_as_it_moves() {
        true => CommandedPlace::Position(target.translation.vector, target.rotation),
        false => CommandedPlace::Pose(target),
    };
    let task = SensitivityTask {
        model,
        tool,
        place,
        wrench,
        direction,
    };
    let found = sensitivities(&task, &[]).expect(name);
    let start = task.place.posture(&mechanism, None).expect(name);
    let rest = start.deflected_by(&wrench).expect(name);
    let mut counted = 0;
    let mut worst = (0.0, String::new());
    for sensitivity in &found.list {
        let p = &sensitivity.parameter;
        let Ok(derivatives) = &sensitivity.derivatives else {
            continue;
        };
        if p.value == 0.0 && !matches!(p.kind, ParameterKind::Length | ParameterKind::Angle) {
            continue;
        }
        // Solved anew, with other steps.
        let parametric = model.parametric(&[&p.path]).expect(name);
        let at = |h: f64| -> Option<Values> {
            let machine = parametric.mechanism(&[p.value + h]).ok()?.with_tool(&tool);
            let posture = task.place.posture(&machine, Some(&start)).ok()?;
            let solved = posture.deflected_from(&wrench, rest.state.clone()).ok()?;
            Some(Values::of(&solved, &direction))
        };
        let least = if p.kind == ParameterKind::Length {
            1e-3
        } else {
            3e-3
        } / p.in_si;
        let h = match p.value {
            0.0 => least,
            v if matches!(p.kind, ParameterKind::Length | ParameterKind::Angle) => {
                (3e-3 * v.abs()).max(least)
            }
            v => 3e-3 * v.abs(),
        };
        let d = |h: f64| Some(at(h)?.combined(&at(-h)?, |a, b| 0.5 * (a - b) / h));
        let (Some(a), Some(b), Some(c)) = (d(h), d(0.5 * h), d(0.25 * h)) else {
            continue;
        };
        let sum = |x: f64, y: f64, z: f64| (x - 20.0 * y + 64.0 * z) / 45.0;
        // What is solved anew is known to some 1e-10 of the figure: a number that changes it by less than 3 % of itself where it
        // doubles is compared beside these 3 %.
        let size = p.value.abs().max(0.1 / p.in_si.max(1.0));
        type Quantity = (&'static str, fn(&Values) -> f64);
        let quantities: [Quantity; 3] = [
            ("deflection", |v| v.deflection),
            ("compliance", |v| v.compliance),
            ("margin", |v| v.share_to_buckling.unwrap_or(0.0)),
        ];
        for (what, of) in quantities {
            let now = of(&found.values).abs();
            if now == 0.0 {
                continue;
            }
            let by_differences = sum(of(&a), of(&b), of(&c));
            let off = apart(of(derivatives), by_differences, 3e-2 * now / size);
            if off > worst.0 {
                worst = (
                    off,
                    format!(
                        "{} {what}: {:e} {by_differences:e}",
                        p.path,
                        of(derivatives)
                    ),
                );
            }
            assert!(
                off < 1e-7,
                "{name}: {} {what}: {:e}, by differences {by_differences:e}, {off:e}",
                p.path,
                of(derivatives)
            );
            counted += 1;
        }
    }
    eprintln!(
        "{name}: {counted} derivatives of {} numbers, at worst {worst:?}",
        found.list.len()
    );
    counted
}

#[test]
fn derivatives_of_an_orthoglide_are_those_of_differences() {
    let model = Model::preset("orthoglide").expect("a preset");
    let load = Wrench::new(
        Vector3::new(215.0, -110.0, -125.0),
        Vector3::new(3.0, -2.0, 1.0),
    );
    let count = compared(
        "orthoglide",
        &model,
        [0.031, -0.047, 0.058],
        load,
        Pose::translation(0.01, -0.02, 0.1),
    );
    assert!(count >= 60, "{count}");
}

#[test]
fn derivatives_of_an_arm_are_those_of_differences() {
    let model = Model::preset("heavy_6r").expect("a preset");
    let load = Wrench::new(
        Vector3::new(700.0, -400.0, -900.0),
        Vector3::new(30.0, 10.0, -20.0),
    );
    let count = compared(
        "heavy_6r",
        &model,
        [0.11, 0.23, -0.17],
        load,
        Pose::translation(0.0, 0.0, 0.2),
    );
    assert!(count >= 60, "{count}");
}

#[test]
fn derivatives_of_a_chain_of_three_links_are_those_of_differences() {
    // With springs in the place of its passive joints, so that it holds any load.
    let text = kinetostat_model::preset_text("three_link_z").expect("a preset");
    let sprung = |text: &str, name: &str, home: &str| {
        let passive =
            format!("passive = \"revolute\", name = \"{name}\", axis = \"z\", home_deg = {home}");
        assert!(text.contains(&passive));
        let spring = format!(
            "spring = \"revolute\", name = \"{name}\", axis = \"z\", stiffness_n_m_per_rad = 2.0, rest_deg = {home}, home_deg = {home}"
        );
        text.replace(&passive, &spring)
    };
    let text = sprung(
        &sprung(text, "q", "9.8960906389829"),
        "e",
        "-9.8960906389829",
    );
    let model = Model::from_toml(&text, "three links").expect("a model");
    let load = Wrench::new(Vector3::new(-0.06, 0.09, 0.0), Vector3::new(0.0, 0.0, 0.02));
    let count = compared(
        "three links",
        &model,
        [0.0, 0.0, 0.0],
        load,
        Pose::translation(0.1, 0.05, 0.0),
    );
    assert!(count >= 10, "{count}");
}
