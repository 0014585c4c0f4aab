//! Files of 200 MB and bombs within the limits of size, through the command itself: refused in words,
//! in bounded memory.

#![cfg(unix)]
#![allow(clippy::print_stdout)] // figures

use std::io::Write;
use std::path::Path;
use std::process::Command;

use crate::common::BINARY;
use kinetostat_testing::Worst;

const MB: usize = 1 << 20;

/// A file that repeats a line up to a size.
fn repeated(path: &Path, head: &str, line: &str, bytes: usize) {
    let mut file = std::io::BufWriter::new(std::fs::File::create(path).expect("a file"));
    let block = line.repeat((MB / line.len()).max(1));
    file.write_all(head.as_bytes()).expect("written");
    let mut written = head.len();
    while written + block.len() <= bytes {
        file.write_all(block.as_bytes()).expect("written");
        written += block.len();
    }
    file.flush().expect("written");
}

/// Runs the command with at most `limit_mb` of address space; what it said, and the memory that it
/// held at most (the limit where the system has no `/usr/bin/time`), MB.
fn limited(folder: &Path, arguments: &[&str], limit_mb: usize) -> (String, f64) {
    let time = Path::new("/usr/bin/time").exists();
    let script = match time {
        true => "ulimit -v $LIMIT && exec /usr/bin/time -f 'peak %M kB' \"$@\"",
        false => "ulimit -v $LIMIT && exec \"$@\"",
    };
    let done = Command::new("sh")
        .args(["-c", script, "sh", BINARY])
        .args(arguments)
        .env("LIMIT", (1024 * limit_mb).to_string())
        .current_dir(folder)
        .output()
        .expect("sh");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(1), "{arguments:?}: {said}");
    assert!(done.stdout.is_empty(), "{arguments:?}");
    let peak = said
        .lines()
        .find_map(|l| l.strip_prefix("peak ")?.strip_suffix(" kB")?.parse().ok());
    let peak = peak.map_or(limit_mb as f64, |kb: f64| kb / 1024.0);
    (said, peak)
}

#[test]
fn figure_files_of_200_mb_are_refused_without_being_read() {
    let here = tempfile::tempdir().expect("a directory");
    let large = here.path().join("large.urdf");
    // Of holes behind its first line: what is not to be read takes no room on the disk of the tests either.
    std::fs::write(&large, "<robot name='r'>\n").expect("a file");
    let opened = std::fs::File::options().write(true).open(&large);
    opened
        .and_then(|file| file.set_len(200 << 20))
        .expect("a file of 200 MB");
    // The same bytes under other names.
    for name in [
        "large.csv",
        "large.json",
        "large.pch",
        "large.toml",
        "large.inp",
    ] {
        std::fs::hard_link(&large, here.path().join(name)).expect("a second name");
    }
    std::fs::write(here.path().join("small.sti"), "1 1 1.0\n").expect("a file");
    std::fs::write(here.path().join("small.dof"), "1.1\n").expect("a file");
    let good = "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>";
    std::fs::write(here.path().join("good.urdf"), good).expect("a file");
    let mut most = Worst::new();
    let queries = [
        "import urdf large.urdf",
        "import urdf good.urdf --joint-stiffness large.csv",
        "import urdf good.urdf --link-section large.toml",
        "import urdf good.urdf --loops large.toml",
        "import matrix large.csv",
        "import matrix large.json",
        "import matrix large.pch --interface 1 --units n-mm",
        "import matrix small.sti --dofs large.inp --interface 1 --nodes large.inp --units n-mm",
        "import matrix small.sti --dofs small.dof --interface 1 --nodes large.inp --units n-mm",
        "import link-displacements large.csv --end-mm 1 0 0",
        "check large.toml",
        "compensate large.toml",
        "tolerance orthoglide --uncertain large.toml",
        "convert part.ngc --to krl --out new.src --template large.toml",
        "mirror part.ngc --measured large.csv --register none --out new.ngc --state large.toml",
        "force --material x --materials large.toml",
    ];
    std::fs::write(
        here.path().join("part.ngc"),
        "G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\n",
    )
    .expect("a file");
    for query in queries {
        let words: Vec<&str> = query.split(' ').collect();
        let (said, peak) = limited(here.path(), &words, 150);
        let reported = ["not read", "larger than", "too large", "a robot in URDF"];
        assert!(reported.iter().any(|w| said.contains(w)), "{query}: {said}");
        assert!(said.contains("large."), "{query}: {said}");
        assert!(peak <= 64.0, "{query}: {peak} MB: {said}");
        most.add(peak);
    }
    figure(
        "bad imports: kinds of files of 200 MB refused by the command",
        queries.len() as f64,
        "at least 10",
        "files",
        queries.len() >= 10,
    );
    let most = most.value();
    figure(
        "bad imports: most memory for a file of 200 MB",
        most,
        "at most 64",
        "MB",
        most <= 64.0,
    );
}

/// A program whose moves do not fit into memory is refused before they are made; threads without a use are not started.
#[test]
fn programs_and_threads_beyond_memory_end_in_words() {
    let here = tempfile::tempdir().expect("a directory");
    let head = "G21 G90\nG0 X0 Y0 Z0\nF100\n";
    repeated(&here.path().join("long.ngc"), head, "G1X1\nX2\n", 3 * MB);
    for query in [
        "expand long.ngc --out flat.ngc",
        "convert long.ngc --to krl --out new.src --tool-orientation a_b_c_kuka_deg=0,0,180",
    ] {
        let words: Vec<&str> = query.split(' ').collect();
        let (said, _) = limited(here.path(), &words, 300);
        for needle in ["long.ngc", "lines", "GB of memory", "divide it"] {
            assert!(said.contains(needle), "{query}: {needle}: {said}");
        }
    }
    let spread =
        "schema = 1\n[[uncertain]]\nparameter = \"chain.leg.q2.length_mm\"\nnormal = 0.02\n";
    std::fs::write(here.path().join("u.toml"), spread).expect("a file");
    for limit in ["600000", "2600000", "3000000"] {
        let script = format!("ulimit -v {limit} && exec \"$@\"");
        let words = "tolerance orthoglide --uncertain u.toml --machines 64 --threads 1024";
        let done = Command::new("sh")
            .args(["-c", &script, "sh", BINARY])
            .args(words.split(' '))
            .current_dir(here.path())
            .output();
        let done = done.expect("sh");
        assert_eq!(done.status.code(), Some(0), "{limit}: {done:?}");
    }
}

/// A file that may not grow any more is an error in words, and leaves nothing beside it.
#[test]
fn files_beyond_the_limit_of_their_size_end_in_words() {
    let here = tempfile::tempdir().expect("a directory");
    let head = "G21 G90\nG0 X0 Y0 Z0\nF100\n";
    repeated(
        &here.path().join("part.ngc"),
        head,
        "G1 X1.25 Y3.5\nX2\n",
        2 * MB,
    );
    for words in [
        "expand part.ngc --out flat.ngc",
        "convert part.ngc --to krl --out new.src --tool-orientation a_b_c_kuka_deg=0,0,180",
        "demo --out demo",
        "model draw orthoglide --out drawn.svg",
    ] {
        let done = Command::new("sh")
            .args(["-c", "ulimit -f 1 && exec \"$@\"", "sh", BINARY])
            .args(words.split(' '))
            .current_dir(here.path())
            .output();
        let done = done.expect("sh");
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(1), "{words}: {done:?}");
        assert!(
            said.contains("larger than is allowed here"),
            "{words}: {said}"
        );
        let left: Vec<_> = std::fs::read_dir(here.path())
            .expect("a directory")
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| name.contains("part") && name != "part.ngc" || name.ends_with(".svg"))
            .collect();
        assert!(left.is_empty(), "{words}: {left:?}");
    }
}

#[test]
fn figure_bombs_within_the_limits_are_refused_in_bounded_memory() {
    let here = tempfile::tempdir().expect("a directory");
    let (urdf, other) = (8 * MB - 4096, 62 * MB);
    let mut most = Worst::new();
    for (name, head, line, size, query) in [
        (
            "elements.urdf",
            "<robot name='r'>",
            "<a/>",
            urdf,
            "import urdf elements.urdf",
        ),
        (
            "deep.urdf",
            "<robot name='r'>",
            "<a>",
            urdf,
            "import urdf deep.urdf",
        ),
        (
            "entities.urdf",
            "<!DOCTYPE r [<!ENTITY a 'aaaaaaaaaa'>]><robot name='r'>",
            "&a;",
            urdf,
            "import urdf entities.urdf",
        ),
        (
            "numbers.json",
            "{\"stiffness_n_mm_rad\":[[",
            "1,",
            other,
            "import matrix numbers.json",
        ),
        (
            "arrays.json",
            "{\"stiffness_n_mm_rad\":[",
            "[1,2,3],",
            other,
            "import matrix arrays.json",
        ),
        ("deep.json", "", "[", other, "import matrix deep.json"),
        (
            "twice.sti",
            "",
            "1 1 1.0\n",
            other,
            "import matrix twice.sti --dofs a.dof --interface 1 --nodes a.inp --units n-mm",
        ),
        (
            "twice.pch",
            "DMIG    KAAX           0       6       2       0\n",
            "DMIG    KAAX           1       1               1       1 1.0\n",
            other,
            "import matrix twice.pch --interface 1 --nodes a.inp --units n-mm",
        ),
    ] {
        repeated(&here.path().join(name), head, line, size);
        std::fs::write(here.path().join("a.dof"), "1.1\n").expect("a file");
        std::fs::write(here.path().join("a.inp"), "*NODE\n1,0,0,0\n").expect("a file");
        let words: Vec<&str> = query.split(' ').collect();
        let (said, peak) = limited(here.path(), &words, 1000);
        assert!(said.contains(name), "{query}: {said:.400}");
        assert!(said.len() < 5000, "{query}: {} bytes", said.len());
        println!("{name}: {peak:.0} MB");
        most.add(peak);
        std::fs::remove_file(here.path().join(name)).expect("removed");
    }
    let most = most.value();
    figure(
        "bad imports: most memory for bombs of 8 MB (URDF) and 62 MB (matrices)",
        most,
        "at most 800",
        "MB",
        most <= 800.0,
    );
}

#[track_caller]
fn figure(name: &str, measured: f64, required: &str, unit: &str, holds: bool) {
    let figure = serde_json::json!({
        "name": name, "measured": measured, "asked": required, "unit": unit, "holds": holds,
    });
    println!("figure {figure}");
    assert!(holds, "{figure}");
}
