//! LinuxCNC's own tree of programs (Debian: linuxcnc-uspace): each file is taken or refused as docs/linuxcnc-nc_files.csv says.
//!
//! The table is made by `validation/scripts/nc_files_with_linuxcnc.py`, which also compares every program that is taken with LinuxCNC's
//! interpreter. The files are GPL and not part of the repository.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use kinetostat_program::*;
use nalgebra::Vector3;

struct Row {
    file: String,
    class: String,
    taken: bool,
    reason: String,
    because: String,
    bare: String,
    linuxcnc: String,
}

/// Fields of a line of CSV.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            letter => fields.last_mut().unwrap().push(letter),
        }
    }
    fields
}

fn table() -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/linuxcnc-nc_files.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "file,class,kinetostat,reason,because,without_options,linuxcnc"
    );
    let rows = lines.map(|line| {
        let found: [String; 7] = fields(line).try_into().unwrap();
        let [file, class, verdict, reason, because, bare, linuxcnc] = found;
        Row {
            file,
            class,
            taken: verdict == "taken",
            reason,
            because,
            bare,
            linuxcnc,
        }
    });
    rows.collect()
}

/// Programs of a class, and how many of them are taken.
fn count(rows: &[Row], class: &str) -> (usize, usize) {
    let own = || rows.iter().filter(|row| row.class == class);
    (own().count(), own().filter(|row| row.taken).count())
}

#[test]
fn the_table_has_a_reason_for_every_file() {
    let rows = table();
    assert_eq!(rows.len(), 222);
    for row in rows.iter().filter(|row| row.class != "no program") {
        match row.taken {
            true => assert!(row.reason.is_empty(), "{}", row.file),
            false => assert!(
                !row.reason.is_empty() && !row.because.is_empty(),
                "{}",
                row.file
            ),
        }
        assert!(!row.linuxcnc.is_empty(), "{}", row.file);
        assert!(
            matches!(row.bare.as_str(), "taken" | "refused"),
            "{}",
            row.file
        );
    }
    let (all, taken) = count(&rows, "milling program");
    assert_eq!(all, 23);
    assert!(10 * taken >= 6 * all, "{taken} of {all}");
}

/// LinuxCNC's tree of programs, or nothing (said plainly).
fn tree() -> Option<PathBuf> {
    let named = std::env::var_os("LINUXCNC_NC_FILES").map(PathBuf::from);
    let shared =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/linuxcnc/ncfiles");
    let installed = PathBuf::from("/usr/share/linuxcnc/ncfiles");
    let mut folders = named.into_iter().chain([shared, installed]);
    let found = folders.find(|folder| folder.is_dir());
    if found.is_none() {
        // Past the capture of the test harness, so that it is seen.
        let _ = writeln!(
            std::io::stderr(),
            "SKIPPED: LinuxCNC's nc_files are not installed (Debian: linuxcnc-uspace; or LINUXCNC_NC_FILES), its programs were not read"
        );
    }
    found
}

/// The folders that hold programs.
fn folders(tree: &Path) -> Vec<PathBuf> {
    let mut found = vec![tree.to_owned()];
    let mut next = 0;
    while next < found.len() {
        let entries = std::fs::read_dir(&found[next]).unwrap();
        let mut inner: Vec<PathBuf> = entries
            .map(|e| e.unwrap().path())
            .filter(|p| p.is_dir())
            .collect();
        inner.sort();
        found.extend(inner);
        next += 1;
    }
    found.sort();
    found
}

struct Folders(Vec<PathBuf>);

impl Subprograms for Folders {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        let mut files = self
            .0
            .iter()
            .map(|folder| folder.join(format!("{name}.ngc")));
        files.find_map(|file| std::fs::read(file).ok())
    }
}

/// What the script gives as well: the machine at zero, tools of a tenth of their number.
fn machine() -> ExpandOptions {
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::LinuxCnc;
    options.tool_diameters_mm = (1..100).map(|n| (n, f64::from(n) / 10.0)).collect();
    let reading = &mut options.reading;
    reading.units = Some(Units::Millimetres);
    reading.start_position_mm = Some(Vector3::zeros());
    reading.machine_zero_mm = Some(Vector3::zeros());
    reading.reference_points_mm = [Some(Vector3::zeros()); 2];
    reading.work_offsets_mm = [Some(Vector3::zeros()); 9];
    reading.other_axes = OtherAxes::StandStill;
    options
}

#[test]
fn figure_every_file_is_taken_or_refused_as_the_table_says() {
    let Some(tree) = tree() else { return };
    let rows: Vec<Row> = table()
        .into_iter()
        .filter(|row| row.class != "no program")
        .collect();
    let folders = folders(&tree);
    let mut found: BTreeMap<&str, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for row in &rows {
        let path = tree.join(&row.file);
        let Ok(bytes) = std::fs::read(&path) else {
            wrong.push(format!("{} is not in the tree", row.file));
            continue;
        };
        let own = path.parent().unwrap().to_owned();
        let library = Folders(
            std::iter::once(own)
                .chain(folders.iter().cloned())
                .collect(),
        );
        let made = expand(bytes.clone(), &machine(), &library);
        let reason = match &made {
            Ok(_) => String::new(),
            Err(error) => format!("line {}: {}", error.line, error.reason),
        };
        if made.is_ok() != row.taken || reason != row.reason {
            wrong.push(format!(
                "{}: '{reason}', the table says '{}'",
                row.file, row.reason
            ));
        }
        let bare = expand(bytes, &ExpandOptions::default(), &library).is_ok();
        if bare != (row.bare == "taken") {
            wrong.push(format!("{}: without options it is taken: {bare}", row.file));
        }
        *found.entry(row.class.as_str()).or_default() += usize::from(made.is_ok());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let milling = found["milling program"];
    let share = 100.0 * milling as f64 / 23.0;
    let name = "LinuxCNC's nc_files: milling programs that go through, of 23";
    assert!(kinetostat_testing::figure::at_least(name, share, 60.0, "%"));
}
