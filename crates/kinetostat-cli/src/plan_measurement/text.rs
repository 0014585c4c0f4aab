//! The plan in words, and the sheet for the shop.

use std::fmt::Write;

use kinetostat_identification::PlanTask;

use crate::plan_measurement::answer::{PlanAnswer, PlanRow};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, number, triple};

pub(crate) fn answer_text(a: &PlanAnswer) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}): {} measurements of {} postures that can be taken ({} passed over)",
            a.model,
            a.model_source,
            a.measurements.len(),
            a.candidates,
            a.passed_over
        ),
        0,
    );
    out.push('\n');
    out.push_str(&columns(&rows(a), 2));
    out.push('\n');
    let mut known = vec![["number", "will be known to"].map(str::to_owned).to_vec()];
    known.extend(a.numbers.iter().map(|n| {
        let percent = n.deviation_percent.map(|d| format!("{} %", number(d, 2)));
        vec![
            n.number.clone(),
            percent.unwrap_or_else(|| "not seen by any reading".to_owned()),
        ]
    }));
    out.push_str(&columns(&known, 2));
    out.push('\n');
    if let Some(efficiency) = a.efficiency {
        out.push_str(&item(&format!(
            "efficiency {} %: no choice of as many of these postures is better by more",
            fixed(100.0 * efficiency, 1)
        )));
    }
    if let Some(times) = a.variance_of_random_plans {
        out.push_str(&item(&format!(
            "postures drawn at random have {} times the variance (median)",
            number(times, 3)
        )));
    }
    if let Some(left) = a.left_error_mm {
        out.push_str(&item(&format!("noise of the readings leaves {} mm at the postures of work after compensation (root mean square)", number(left, 2))));
    }
    if a.numbers.iter().any(|n| n.deviation_percent.is_none()) {
        out.push_str(&item("what no reading sees needs another load: a pull from the side (--pull-n) turns a joint whose axis is vertical, a load beside the last axis turns the last joint"));
    }
    out
}

fn rows(a: &PlanAnswer) -> Vec<Vec<String>> {
    let names = a.measurements.first().map_or_else(Vec::new, |m| {
        m.axes
            .iter()
            .map(|x| format!("{} {}", x.name, x.unit))
            .collect()
    });
    let mut rows = vec![vec!["".to_owned()]];
    rows[0].extend(names);
    rows[0].extend(["force, N", "moves, mm"].map(str::to_owned));
    rows.extend(a.measurements.iter().map(|m: &PlanRow| {
        let mut row = vec![m.posture.clone()];
        row.extend(m.axes.iter().map(|x| fixed(x.value, 3)));
        row.push(triple(m.force_n, |x| fixed(x, 0)));
        row.push(fixed(m.expected_displacement_mm, 2));
        row
    }));
    rows
}

/// What a person takes to the machine: the postures in order, with lines to write the readings on.
pub(crate) fn sheet(a: &PlanAnswer, task: &PlanTask<'_>) -> String {
    let mut out = format!(
        "Measurement of {}\n\nDate:                    Name:                    Instrument:\n\nTool and work-object data that the controller applies must be off, or those of the model.\nFor each posture: jog to the axes, let the machine settle, read without the load, put the load\non, read, take it off, read again. Note the load that was measured, not the one that is planned.\n",
        a.model
    );
    let on = a
        .load_on
        .as_ref()
        .map_or(String::new(), |node| format!(" on {node}"));
    for m in &a.measurements {
        let axes: Vec<String> = m
            .axes
            .iter()
            .map(|x| format!("{} {} {}", x.name, fixed(x.value, 3), x.unit))
            .collect();
        let _ = write!(
            out,
            "\n{:>3}  {}\n     force {} N (base axes){on}   expected about {} mm   tool at {} mm\n",
            m.posture,
            axes.join("   "),
            triple(m.force_n, |x| fixed(x, 0)),
            fixed(m.expected_displacement_mm, 2),
            triple(m.position_mm, |x| fixed(x, 0)),
        );
        for (k, marker) in task.markers.iter().enumerate() {
            let at = triple((marker * 1e3).into(), |x| fixed(x, 1));
            let _ = writeln!(
                out,
                "     marker {} at {at} mm:  before ______ ______ ______  loaded ______ ______ ______  after ______ ______ ______",
                k + 1
            );
        }
    }
    out
}
