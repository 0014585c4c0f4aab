//! Real public programs, read where they lie; none of them is copied here.

use std::io::Write as _;

use kinetostat_formats::*;

use crate::paths::corrected;
use crate::real_files::{programs_with, stated};

/// Motions of programs that are corrected along their paths, too: more take minutes here.
const MOST_CORRECTED: usize = 3000;

/// Programs that are read, run flat where they need it, come back byte for byte, and are corrected along their paths.
#[test]
fn real_programs_come_back_and_are_corrected() {
    let all = programs_with("siemens", &["mpf", "spf"]);
    let (mut read, mut expanded, mut refused) = (Vec::new(), Vec::new(), Vec::new());
    let main = |name: &str| name.to_ascii_lowercase().ends_with(".mpf");
    for (name, bytes) in all.iter().filter(|(name, _)| main(name)) {
        let owner = name.split("__").next().unwrap();
        // A word of the interpreter that the programs of one repository are written for; no control has it.
        let printless: Vec<u8> = bytes
            .split_inclusive(|byte| *byte == b'\n')
            .filter(|line| !line.trim_ascii_start().starts_with(b"println("))
            .flatten()
            .copied()
            .collect();
        let bytes = &printless;
        let mut files = vec![SourceFile::new(name.clone(), bytes.clone())];
        for (other, bytes) in &all {
            if !main(other) && other.starts_with(owner) {
                // Folders are part of the name.
                let own = other.rsplit("Sub_").next().unwrap();
                let own = own.rsplit("sinumerik_").next().unwrap();
                files.push(SourceFile::new(own, bytes.clone()));
            }
        }
        let flat = match expand_siemens(&files) {
            Ok(flat) => flat,
            Err(errors) => {
                refused.push((name, errors[0].to_string()));
                continue;
            }
        };
        assert!(flat.changed || flat.file.bytes() == bytes, "{name}");
        let text = flat.file.bytes().to_vec();
        let program = match read_siemens(vec![flat.file], &stated()) {
            Ok(program) => program,
            Err(errors) => {
                refused.push((name, errors[0].to_string()));
                continue;
            }
        };
        let same = write(&program, &[], &WriteOptions::default()).unwrap();
        assert!(same[0].1 == text, "{name}");
        let few = program.motions.len() <= MOST_CORRECTED;
        if few && let Err(why) = corrected(Language::Siemens, name, &text, &stated()) {
            refused.push((name, why));
            continue;
        }
        match flat.changed {
            true => expanded.push((name, program.motions.len())),
            false => read.push((name, program.motions.len())),
        }
    }
    let _ = writeln!(
        std::io::stderr(),
        "{} SINUMERIK programs are read as they are: {read:?}; {} run flat: {expanded:?}; refused: {refused:#?}",
        read.len(),
        expanded.len()
    );
    assert!(all.is_empty() || read.len() + expanded.len() >= 12);
}
