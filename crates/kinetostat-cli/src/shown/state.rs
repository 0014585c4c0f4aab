//! A machine in a state under a load, as the page shows it.

use kinetostat::chain::CartesianCompliance;
use kinetostat::{MechanismEquilibrium, MotionKind, Posture, Wrench};
use kinetostat_analysis::shares::Shares;
use kinetostat_report::{Placed, Scene};
use nalgebra::{Matrix3, Vector3, Vector6};

use crate::place::joints;
use crate::shown::answer::{
    Compliance, Figure, LimbLoad, RotaryCompliance, ShareOfPart, StateAnswer,
};
use crate::ui::numbers::{fixed, number, triple};

/// The answer for a posture; `named` is the machine as the command line names it.
pub(crate) fn state_of(posture: &Posture, wrench: &Wrench, named: &str) -> StateAnswer {
    let mechanism = posture.mechanism();
    let values = joints::of_model(mechanism, &posture.commands());
    let solved = posture
        .deflected_by(&Wrench::zero())
        .and_then(|rest| Ok((posture.deflected_by(wrench)?, rest)));
    let (solved, finding) = match solved {
        Ok(solved) => (Some(solved), None),
        Err(error) => (None, Some(error.to_string())),
    };
    let loaded = solved.as_ref().map(|(loaded, _)| loaded);
    let moved = solved.as_ref().map(|(loaded, rest)| {
        let by_load = loaded.displacement.linear() - rest.displacement.linear();
        (loaded.displacement.linear() * 1e3, by_load * 1e3)
    });
    let compliance = loaded.map(MechanismEquilibrium::compliance);
    let scene = Scene::of(mechanism, &Placed::at(posture));
    StateAnswer {
        actuators: values.iter().map(|v| v.value).collect(),
        within_limits: posture.within_limits().is_ok(),
        tool: posture.target().into(),
        tool_deflected: loaded.map(|found| (&found.tool).into()),
        deflected: loaded.map(|found| Scene::of(mechanism, &Placed::solved(posture, &found.state))),
        scene,
        force_n: wrench.force().into(),
        moment_n_m: wrench.moment().into(),
        figures: solved
            .as_ref()
            .map_or_else(Vec::new, |(loaded, rest)| figures(posture, loaded, rest)),
        displacement_mm: moved.map(|(all, _)| all.into()),
        displacement_by_load_mm: moved.map(|(_, by_load)| by_load.into()),
        turn_mrad: loaded.map(|found| (found.displacement.angular() * 1e3).into()),
        compliance: compliance.as_ref().and_then(|c| {
            let (axes, um_per_n) = principal(c, 0)?;
            Some(Compliance { axes, um_per_n })
        }),
        rotary_compliance: compliance.as_ref().and_then(|c| {
            let (axes, urad_per_n_m) = principal(c, 3)?;
            Some(RotaryCompliance { axes, urad_per_n_m })
        }),
        shares: loaded.map_or_else(Vec::new, |found| shares(posture, found, wrench)),
        stable: loaded.map(MechanismEquilibrium::stable),
        limb_loads: loaded.map_or_else(Vec::new, limb_loads),
        finding,
        cli: command(named, &values, wrench),
        python: python(named, &posture.commands(), wrench),
    }
}

/// Shares of all that yields in the displacement along the load.
fn shares(posture: &Posture, found: &MechanismEquilibrium, wrench: &Wrench) -> Vec<ShareOfPart> {
    // Without a load there is no direction, and no shares.
    let Ok(shares) = Shares::at(posture, found, wrench) else {
        return Vec::new();
    };
    let each = shares.elastic().into_iter().map(|part| ShareOfPart {
        part: part.name.clone(),
        limb: part.limb.clone(),
        percent: 100.0 * part.share,
    });
    each.collect()
}

fn limb_loads(found: &MechanismEquilibrium) -> Vec<LimbLoad> {
    let each = found.limbs.iter().map(|limb| LimbLoad {
        limb: limb.name.clone(),
        force_n: limb.wrench.force().into(),
        share_to_buckling: limb.stability.share_to_buckling.filter(|m| m.is_finite()),
    });
    each.collect()
}

/// Principal axes of a block of the compliance, and its values there in millionths; none if a direction is free. The block begins with
/// direction `first`: 0 for displacements by forces, 3 for turns by moments.
fn principal(compliance: &CartesianCompliance, first: usize) -> Option<(Vec<[f64; 3]>, Vec<f64>)> {
    let mut block = Matrix3::zeros();
    for k in 0..3 {
        let twist = compliance.twist_under(&Wrench(Vector6::ith(first + k, 1.0)))?;
        block.set_column(k, &twist.0.fixed_rows::<3>(first));
    }
    let eigen = (0.5 * (block + block.transpose())).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let axes = order.map(|k| eigen.eigenvectors.column(k).into_owned().into());
    let values = order.map(|k| 1e6 * eigen.eigenvalues[k]);
    Some((axes.into(), values.into()))
}

fn figures(
    posture: &Posture,
    loaded: &MechanismEquilibrium,
    rest: &MechanismEquilibrium,
) -> Vec<Figure> {
    let figure = |label: &str, value: String| Figure {
        label: label.to_owned(),
        value,
        detail: None,
    };
    // A vector by its size, with its components; both in thousandths.
    let sized = |label: &str, v: Vector3<f64>, digits: i32, unit: &str| Figure {
        detail: Some(format!(
            "{} {unit}",
            triple((v * 1e3).into(), |x| fixed(x, 4))
        )),
        ..figure(label, format!("{} {unit}", number(1e3 * v.norm(), digits)))
    };
    let (all, without) = (loaded.displacement.linear(), rest.displacement.linear());
    let mut found = vec![sized("Displacement of the tool", all, 4, "mm")];
    // Of a machine without weight, what is left is rounding.
    if without.norm() > 1e-12 {
        if loaded.wrench.0.norm() > 0.0 {
            found.push(sized("by the load", all - without, 4, "mm"));
        }
        found.push(sized("without it: weight, deviations", without, 4, "mm"));
    }
    let turn = loaded.displacement.angular();
    found.push(sized("Turn of the tool", turn, 3, "mrad"));
    let softest = 1e-3 * loaded.stiffness_against_force();
    let softest = match softest.is_finite() {
        true => format!("{} N/mm", number(softest, 4)),
        false => "rigid".to_owned(),
    };
    found.push(figure("Softest against a force", softest));
    let stable = if loaded.stable() { "yes" } else { "no" };
    found.push(figure("Stable", stable.to_owned()));
    let mechanism = posture.mechanism();
    let kinds = joints::kinds(mechanism).into_iter();
    let drives = mechanism.actuator_names().into_iter().zip(kinds);
    for ((name, kind), force) in drives.zip(loaded.actuator_forces()) {
        let unit = match kind {
            MotionKind::Prismatic => "N",
            MotionKind::Revolute => "N m",
        };
        found.push(figure(
            &format!("Drive {name}"),
            format!("{} {unit}", number(force, 4)),
        ));
    }
    found
}

/// The command that says the same.
fn command(named: &str, values: &[joints::JointValue], wrench: &Wrench) -> String {
    let quoted = |text: &str| match text
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || "_-./=".contains(c))
    {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    };
    let joints = values
        .iter()
        .map(|v| quoted(&format!("{}={}", v.name, v.value)));
    let mut out = format!(
        "kinetostat deflect {} --joints {}",
        quoted(named),
        joints.collect::<Vec<_>>().join(" ")
    );
    for (option, v) in [("force", wrench.force()), ("moment", wrench.moment())] {
        if v != Vector3::zeros() {
            out += &format!(" --{option} {} {} {}", v.x, v.y, v.z);
        }
    }
    out
}

fn python(named: &str, commands: &[f64], wrench: &Wrench) -> String {
    let (f, m): ([f64; 3], [f64; 3]) = (wrench.force().into(), wrench.moment().into());
    format!(
        "import kinetostat as ks\nposture = ks.Machine.open({named:?}).posture(joints={commands:?})  # m, rad\nloaded = posture.deflected_by(ks.wrench({f:?}, {m:?}))  # N, N m"
    )
}
