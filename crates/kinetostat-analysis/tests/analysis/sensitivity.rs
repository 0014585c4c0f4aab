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

fn of_hexapod(model: &Model, moved: Vector3<f64>, wrench: Wrench) -> SensitivityTask<'_> {
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    SensitivityTask {
        model,
        tool: Pose::identity(),
        place: CommandedPlace::Pose(Pose::from_parts(
            (home.translation.vector + moved).into(),
            home.rotation,
        )),
        wrench,
        direction: Wrench::new(Vector3::x(), Vector3::zeros()),
    }
}

/// The share of the way to buckling of the machine with one number elsewhere, solved anew.
fn share_at(task: &SensitivityTask<'_>, path: &str, value: f64) -> f64 {
    let parametric = task.model.parametric(&[path]).expect(path);
    let machine = parametric.mechanism(&[value]).expect(path);
    let posture = task.place.posture(&machine, None).expect(path);
    let found = posture.deflected_by(&task.wrench).expect(path);
    found.share_to_buckling().expect("a load that buckles")
}

#[test]
fn the_margin_follows_the_limb_that_is_nearest_although_another_overtakes_it_within_the_step() {
    let model = Model::preset("hexapod").expect("a preset");
    let wrench = Wrench::new(
        Vector3::new(150.0, -90.0, -180.0),
        Vector3::new(12.0, 7.0, -9.0),
    );
    let task = of_hexapod(&model, Vector3::new(0.01, 0.02, -0.01), wrench);
    let path = "mechanism.gravity_m_per_s2.x";
    let found = sensitivities(&task, &[path]).expect("derivatives");
    let own = found.list[0].derivatives.as_ref().expect(path);
    let own = own.share_to_buckling.expect("a load that buckles");
    // At -0.005 m/s^2 another leg is the nearest one: the step of the differences inside is 0.01.
    let h = 2e-3;
    let difference = |h: f64| (share_at(&task, path, h) - share_at(&task, path, -h)) / (2.0 * h);
    let by_differences = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
    assert!(
        (own - by_differences).abs() < 1e-6 * by_differences.abs(),
        "{own:e}, by differences {by_differences:e}"
    );
    assert!(!found.list[0].sharp.share_to_buckling);
}

#[test]
fn a_margin_that_turns_sharply_is_told() {
    let model = Model::preset("hexapod").expect("a preset");
    let wrench = Wrench::new(Vector3::new(0.0, 0.0, -1000.0), Vector3::zeros());
    let task = of_hexapod(&model, Vector3::zeros(), wrench);
    // All legs are equally near: one that starts elsewhere, and all that become stiffer.
    let (one, all) = (
        "limb.leg 1.start.position_mm.z",
        "mechanism.gravity_m_per_s2.z",
    );
    let found = sensitivities(&task, &[one, all]).expect("derivatives");
    let now = found.values.share_to_buckling.expect("a load that buckles");
    let (h, at) = (1e-2, found.list[0].parameter.value);
    let right = (share_at(&task, one, at + h) - now) / h;
    let left = (now - share_at(&task, one, at - h)) / h;
    assert!(
        (right - left).abs() > 0.5 * right.abs().max(left.abs()),
        "{left:e} {right:e}"
    );
    assert!(found.list[0].sharp.share_to_buckling, "{:?}", found.list[0]);
    assert!(
        !found.list[1].sharp.share_to_buckling,
        "{:?}",
        found.list[1]
    );
}

#[test]
fn a_number_that_changes_the_margin_alone_has_an_effect() {
    let model = Model::preset("delta").expect("a preset");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let task = SensitivityTask {
        model: &model,
        tool: Pose::identity(),
        place: CommandedPlace::Pose(home),
        wrench: Wrench::new(Vector3::new(0.0, 0.0, -100.0), Vector3::zeros()),
        direction: Wrench::new(Vector3::z(), Vector3::zeros()),
    };
    let path = "section.rod.poissons_ratio";
    let found = sensitivities(&task, &[path]).expect("derivatives");
    let own = found.list[0].derivatives.as_ref().expect(path);
    let by_differences = (share_at(&task, path, 0.31) - share_at(&task, path, 0.29)) / 0.02;
    let share = own.share_to_buckling.expect("a load that buckles");
    assert!((share - by_differences).abs() < 1e-3 * by_differences.abs());
    let number = &found.list[0].parameter;
    assert!(!own.is_nothing(number.value, &found.values), "{own:?}");
}
