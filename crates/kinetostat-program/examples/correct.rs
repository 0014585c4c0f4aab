//! Corrects a program by a map: `correct PROGRAM MAP OUTPUT [--units mm|inch]`.
//!
//! ```text
//! cargo run -p kinetostat-program --example correct -- part.ngc map.csv corrected.ngc
//! ```

use std::error::Error;
use std::io::Write;

use kinetostat_program::*;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, map, output, rest @ ..] = arguments.as_slice() else {
        return Err("usage: correct PROGRAM MAP OUTPUT [--units mm|inch]".into());
    };
    let units = match rest {
        [] => None,
        [flag, unit] if flag == "--units" && unit == "mm" => Some(Units::Millimetres),
        [flag, unit] if flag == "--units" && unit == "inch" => Some(Units::Inches),
        _ => return Err("only --units mm or --units inch may follow".into()),
    };
    let reading = {
        let mut reading = ReadOptions::default();
        reading.units = units;
        reading
    };
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = Some(vec![format!("corrected by the map {map}")]);
        writing
    };

    let program = Program::read(std::fs::read(input)?)?;
    let path = interpret(&program, &reading)?;
    let field = CorrectionMap::read(&std::fs::read(map)?)?;
    let written = write_corrected(&program, &path, &field, &writing, &Unwatched)?;
    let found = verify_written(&program, &path, &written, &reading, &writing)?;
    std::fs::File::create_new(output)?.write_all(&written.bytes)?;

    let account = &written.accounting;
    writeln!(
        std::io::stdout(),
        "{} blocks in, {} carried, {} corrected, {} split; {} blocks out; largest correction {:.4} mm, \
         rounding {:.5} mm, speed kept within {:.3} %; {} points asked for",
        account.blocks_in,
        account.blocks_carried,
        account.blocks_corrected,
        account.blocks_split,
        account.blocks_out,
        account.largest_correction_mm,
        account.largest_rounding_mm,
        found.largest_speed_error * 100.0,
        account.evaluations
    )?;
    for warning in &account.warnings {
        writeln!(std::io::stdout(), "line {}: {}", warning.line, warning.text)?;
    }
    Ok(())
}
