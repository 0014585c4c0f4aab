//! Jobs with a material that ask for what cannot be: each fault once, with its line.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use crate::common::{Said, contents, run};
use crate::cut::{JOB, PASS, place};

fn compensate(job: &str) -> Said {
    let here = place(job, PASS);
    let said = run(here.path(), &["compensate", "job.toml"]);
    if said.code == 1 {
        let names: Vec<_> = contents(here.path()).into_keys().collect();
        assert_eq!(names.len(), 2, "something was written: {names:?}");
    }
    said
}

/// What is wrong, on which line, in how many faults in all.
fn refused(job: &str, line: &str, needle: &str, faults: usize) {
    let said = compensate(job);
    assert_eq!(said.code, 1, "{said:?}");
    let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains(needle), "{needle}: {flat}");
    assert!(flat.contains(&format!("job.toml:{line}")), "{line}: {flat}");
    assert_eq!(flat.matches("job.toml:").count(), faults, "{flat}");
}

#[test]
fn a_fault_of_the_stock_is_the_only_one() {
    refused(
        &JOB.replace("[stock]\n", "[stock]\ncell_mm = -1\n"),
        "12",
        "cell",
        1,
    );
    let cylinder = "cylinder = { foot_mm = [0, 0, 0], radius_mm = 0, height_mm = 3 }";
    let job = JOB.replace("block_mm = [[0, -20, -12], [20, 0, 0]]", cylinder);
    refused(&job, "11", "stock along x: 0 mm", 1);
    refused(
        &JOB.replace("AlMg4.5Mn", "AlMg4.5"),
        "10",
        "did you mean",
        1,
    );
    refused(&JOB.replace("teeth = 2", "teeth = 0"), "8", "teeth", 1);
}

#[test]
fn a_cell_is_not_finer_than_it_is_of_use() {
    let job = JOB
        .replace("diameter_mm = 6", "diameter_mm = 100")
        .replace("[stock]\n", "[stock]\ncell_mm = 0.02\n");
    refused(&job, "12", "at least 0.1", 1);
}

#[test]
fn keys_of_a_table_of_tools_are_no_part_of_a_cutter() {
    for key in ["number = 3", "length_mm = 60"] {
        let job = JOB.replace("helix_deg = 30", &format!("helix_deg = 30, {key}"));
        refused(&job, "8", "is no part of a cutter in a job", 1);
    }
}

#[test]
fn lines_have_one_engagement_and_a_cut() {
    let lines = |text: &str| {
        JOB.replace("[stock]", "[engagement]")
            .replace("block_mm = [[0, -20, -12], [20, 0, 0]]", text)
    };
    let cut = |from: usize, to: usize| {
        format!("{{ from = {from}, to = {to}, width_mm = 2, depth_mm = 1, part = \"right\" }}")
    };
    let twice = format!("lines = [{}, {}]", cut(4, 5), cut(5, 6));
    refused(
        &lines(&twice),
        "12",
        "lines 4 to 5 have an engagement already",
        1,
    );
    let said = compensate(&lines(&format!("lines = [{}, {}]", cut(5, 5), cut(6, 9))));
    assert_eq!(said.code, 4, "{said:?}");
    let flat = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains("line 6: lines 6 to 9 have an engagement, and no feed move stands on them"),
        "{flat}"
    );
    // One width is another cut for another diameter.
    let two = "[tool]\nlength_mm = 0\n[[tools]]\nnumber = 1\nlength_mm = 0\ncutter = { shape = \"flat\", diameter_mm = 6, teeth = 2 }\n[[tools]]\nnumber = 2\nlength_mm = 0\ncutter = { shape = \"flat\", diameter_mm = 12, teeth = 2 }\n";
    let (before, after) = JOB.split_once("[tool]").unwrap();
    let (_, after) = after.split_once("[material]").unwrap();
    let job = format!("{before}{two}[material]{after}")
        .replace("[stock]", "[engagement]")
        .replace(
            "block_mm = [[0, -20, -12], [20, 0, 0]]",
            "width_mm = 2\ndepth_mm = 1\npart = \"left\"",
        );
    refused(&job, "18", "tools of different diameters", 1);
}

#[test]
fn a_step_of_the_correction_has_bounds() {
    let job = JOB.replace("[output]", "[load]\nlargest_step_mm_per_mm = 0\n[output]");
    refused(&job, "14", "0.0001 to 10 mm per mm", 1);
}

/// A feed of drills says nothing of a milling cut.
#[test]
fn a_feed_per_turn_is_not_of_milling() {
    let here = tempfile::tempdir().unwrap();
    let cut = "force --material AlMg4.5Mn --tool flat --diameter-mm 12 --teeth 4 --width-mm 4 --depth-mm 8 --climb --feed-per-tooth-mm 0.1 --feed-per-turn-mm 0.2";
    let said = run(here.path(), &cut.split(' ').collect::<Vec<_>>());
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("--feed-per-tooth-mm"), "{said:?}");
}

/// A feed beyond what the tool's maker allows, and a file that is not there: each where it stands, nothing written.
#[test]
fn feeds_that_break_the_tool_are_not_compensated() {
    // 600 mm/min at 12000 rpm with 2 teeth: 0.025 mm per tooth, on line 5.
    let limited = |most: f64| {
        let edge = format!("helix_deg = 30, max_chip_mm = {most}");
        compensate(&JOB.replace("helix_deg = 30", &edge))
    };
    let said = limited(0.02);
    assert_eq!(said.code, 1, "{said:?}");
    let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    let needle = "pass.ngc: line 5: a feed of 0.025 mm per tooth; the tool's maker allows 0.02 mm";
    assert!(flat.contains(needle), "{flat}");
    assert_eq!(limited(0.03).code, 4);
}

#[test]
fn a_file_that_is_missing_is_named_where_the_job_names_it() {
    let cutters = JOB.replace("[material]", "[cutters]\nfile = \"none.toml\"\n[material]");
    refused(&cutters, "10", "'none.toml' does not exist", 1);
    let mesh = JOB.replace(
        "block_mm = [[0, -20, -12], [20, 0, 0]]",
        "stl = \"none.stl\"",
    );
    refused(&mesh, "12", "'none.stl' does not exist", 1);
}

#[test]
fn a_speed_of_the_spindle_is_refused_where_it_stands() {
    let spindle = |most: &str| {
        let table = format!("[spindle]\npower_w = 800\nbase_rpm = 10000\nmost_rpm = {most}\n");
        JOB.replace("[output]", &format!("{table}[output]"))
    };
    refused(&spindle("900"), "16", "largest speed: 900 rpm", 1);
    refused(&spindle("\"fast\""), "16", "a number", 1);
    let base = spindle("24000").replace("base_rpm = 10000", "base_rpm = -1");
    refused(&base, "15", "base speed: -1 rpm", 1);
}

/// A cut behind the ends of the edges, and a cutter that is longer than its tool.
#[test]
fn a_tool_that_is_too_short_is_not_compensated() {
    let with = |keys: &str| JOB.replace("helix_deg = 30", &format!("helix_deg = 30, {keys}"));
    let said = compensate(&with("stick_out_mm = 1"));
    assert_eq!(said.code, 1, "{said:?}");
    let flat = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        flat.contains(
            "pass.ngc: line 5: material up to 2 mm above the tip; edges or tool are 1 mm long"
        ),
        "{flat}"
    );
    let long = with("stick_out_mm = 150").replace("length_mm = 0", "length_mm = 100");
    refused(
        &long,
        "8",
        "stands 150 mm out of its holder, and the whole tool is 100 mm long",
        1,
    );
}

/// What is wrong in a table is said once, where it stands.
#[test]
fn a_wrong_word_in_a_table_is_the_only_fault() {
    refused(
        &JOB.replace("\"AlMg4.5Mn\"", "5"),
        "10",
        "text in quotes is needed",
        1,
    );
    let measured = JOB.replace(
        "[material]\nname = \"AlMg4.5Mn\"\n[stock]\nblock_mm = [[0, -20, -12], [20, 0, 0]]",
        "[measured]\nfile = \"log.csv\"\nacts_on = \"spindle\"",
    );
    refused(&measured, "11", "'spindle' is not known here", 1);
}
