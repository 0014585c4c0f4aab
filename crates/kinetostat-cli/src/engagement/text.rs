//! The answer for a person, readable at 80 columns.

use kinetostat_machining::CutPlace;

use crate::engagement::answer::{EngagementAnswer, StockAnswer, ToolAnswer};
use crate::ui::layout::{columns, item, listed, wrapped};
use crate::ui::numbers::{fixed, given, number, triple};
use crate::ui::warnings::warnings;

/// Lines with the largest forces that are listed.
const WORST: usize = 5;

pub(crate) fn answer_text(a: &EngagementAnswer) -> String {
    let tools: Vec<String> = a.tools.iter().map(tool).collect();
    let mut out = wrapped(
        &format!("{} in {}, {}", a.program, a.material, tools.join("; ")),
        0,
    );
    out.push('\n');
    out.push_str(&wrapped(&result_text(a), 2));
    if let Some(figures) = figures(a) {
        out.push('\n');
        out.push_str(&listed(&figures, 2));
        out.push('\n');
        out.push_str(&worst(&a.cutting.worst_lines));
    }
    out.push_str("\nWhat this rests on\n");
    out.extend(a.assumed.iter().map(|sentence| item(sentence)));
    out.push_str(&warnings(&a.warnings));
    out
}

fn tool(tool: &ToolAnswer) -> String {
    let number = tool
        .number
        .map_or_else(String::new, |number| format!("T{number}: "));
    format!(
        "{number}{} cutter of {} mm, {} teeth, helix {} deg",
        tool.shape,
        given(tool.diameter_mm),
        tool.teeth,
        given(tool.helix_deg)
    )
}

/// Two sentences that answer the question.
fn result_text(a: &EngagementAnswer) -> String {
    let c = &a.cutting;
    let Some(force) = &c.largest_force else {
        return "The program cuts nothing: the tool meets no material on its feed moves."
            .to_owned();
    };
    let taken = match &a.stock {
        Some(stock) => format!(
            "The program takes {} off the stock, {} % of it.",
            volume(stock.removed_mm3),
            number(stock.removed_percent, 3)
        ),
        None => "The engagement is stated, not from a stock: no volume is known, and the picture has no map.".to_owned(),
    };
    let more = 1.0 + 0.01 * c.spread_percent;
    format!(
        "{taken} The force on the tool is up to {} N, at line {}; another batch, tool or table may make {} N of it ({} % more).",
        number(force.force_n(), 3),
        force.line,
        number(more * force.force_n(), 3),
        number(c.spread_percent, 2)
    )
}

fn volume(mm3: f64) -> String {
    match mm3.abs() < 1e5 {
        true => format!("{} mm3", number(mm3, 3)),
        false => format!("{} cm3", number(1e-3 * mm3, 3)),
    }
}

/// The largest figures with their lines and places; none where nothing is cut.
fn figures(a: &EngagementAnswer) -> Option<Vec<Vec<String>>> {
    let c = &a.cutting;
    let row = |name: &str, value: String, at: &CutPlace| {
        let place = format!("at {}", triple(at.position_mm, |x| fixed(x, 2)));
        vec![name.to_owned(), value, format!("line {}", at.line), place]
    };
    let (force, torque) = (c.largest_force?, c.largest_torque?);
    let (power, chip) = (c.largest_power?, c.largest_chip?);
    let mut rows = Vec::new();
    if let Some(StockAnswer {
        removed_mm3,
        volume_mm3,
        ..
    }) = a.stock
    {
        let of = format!("of {}", volume(volume_mm3));
        rows.push(vec!["taken off".to_owned(), volume(removed_mm3), of]);
    }
    let of = format!("of {} mm at feed", number(a.feed_length_mm, 5));
    let cut = format!("{} mm", number(c.cut_length_mm, 5));
    rows.push(vec!["way in the material".to_owned(), cut, of]);
    rows.push(row(
        "largest force",
        format!("{} N", number(force.force_n(), 3)),
        &force,
    ));
    rows.push(row(
        "largest torque",
        format!("{} N m", number(torque.torque_n_m, 3)),
        &torque,
    ));
    rows.push(row(
        "largest power",
        format!("{} W", number(power.power_w, 3)),
        &power,
    ));
    rows.push(row(
        "thickest chip",
        format!("{} mm", number(chip.chip_mm, 3)),
        &chip,
    ));
    if let Some(place) = c.nearest_to_spindle
        && let Some(gives) = place.spindle_torque_n_m
    {
        let share = 100.0 * place.torque_n_m / gives;
        let value = format!("{} %", number(share, 3));
        rows.push(row("of the spindle's torque", value, &place));
    }
    Some(rows)
}

fn worst(places: &[CutPlace]) -> String {
    let head = [
        "largest forces",
        "N",
        "along",
        "left",
        "up",
        "N m",
        "W",
        "deep, mm",
        "arc, deg",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for p in places.iter().take(WORST) {
        let mut row = vec![format!("line {}", p.line)];
        let forces = [
            p.force_n(),
            p.force_along_feed_n,
            p.force_left_n,
            p.force_up_n,
        ];
        row.extend(forces.map(|n| fixed(n, 1)));
        row.push(number(p.torque_n_m, 3));
        row.push(number(p.power_w, 3));
        row.push(number(p.depth_mm, 3));
        row.push(fixed(p.arc_deg, 0));
        rows.push(row);
    }
    columns(&rows, 2)
}
