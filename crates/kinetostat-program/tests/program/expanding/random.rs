//! Random programs with macros: whatever they are, they are expanded or refused with a line, at once; what is expanded is plain.

use kinetostat_program::{
    Dialect, ExpandOptions, NoSubprograms, expand, expand_or_faults, expansion_faults, interpret,
};
use nalgebra::Vector3;

/// Pieces of programs: what belongs together stands in one.
const PIECES: &[&str] = &[
    "G21 G90\nG0 X0 Y0 Z5\n",
    "G20\n",
    "G91\n",
    "G90\n",
    "G98 ",
    "G99 ",
    "F100 ",
    "M3 S1000\n",
    "G80\n",
    "G17\n",
    "G18\n",
    "G0 X#1 Y[#2+1]\n",
    "G1 X[SIN[#1]*10] F100\n",
    "X[#3]\n",
    "#1=3\n",
    "#2=[#1*2-1] ",
    "#<a>=#1\n",
    "#<_b>=[#<a>+1]\n",
    "#[#1+30]=2\n",
    "##1=5\n",
    "O1 sub\nX#1\nO1 endsub\n",
    "O1 call [1] [#2]\n",
    "O1 sub\n",
    "O1 endsub [3]\n",
    "O1 return [#1]\n",
    "O2 while [#1 GT 0]\n#1=[#1-1]\n",
    "O2 endwhile\n",
    "O3 if [#1 EQ 3]\n",
    "O3 elseif [1]\n",
    "O3 else\n",
    "O3 endif\n",
    "O4 do\n",
    "O4 while [#1 LT 2]\n",
    "O5 repeat [#1]\n",
    "O5 endrepeat\n",
    "O2 break\n",
    "O4 continue\n",
    "O<x> call\n",
    "M98 P7 L2\n",
    "O7\nX1\nM99\n",
    "M99\n",
    "M30\n",
    "M2\n",
    "%\n",
    "N5 X2\n",
    "GOTO 5\n",
    "IF [#1 LT 3] GOTO 5\n",
    "IF [1] THEN #1=2\n",
    "WHILE [#1 GT 0] DO1\n#1=[#1-1]\n",
    "END1\n",
    "G81 X1 Z-3 R1\n",
    "G83 X2 Z-3 R1 Q1\n",
    "G73 Z-2 R1 Q0.5\n",
    "X3 Y4\n",
    "L3 ",
    "G85 ",
    "G89 P1 Z-1 R1\n",
    "G87 I1 J0 K-1 Z-2 R1\n",
    "@3 ^30\n",
    "^60 ",
    "@[#1]\n",
    "G2 X1 Y1 I1 J0\n",
    "(comment #1)\n",
    "; [ #\n",
    "/ X1\n",
    "[",
    "]",
    "#",
    "1 / 0",
    "ATAN[1]/[0]",
    "**",
    "EXISTS[#<a>]",
    "\n",
    " ",
    "G92 X0\n",
    "G55\n",
    "T1 M6\n",
    "G41\n",
    "G42 D1 ",
    "G41.1 D0.5\n",
    "G42.1 D-3 ",
    "G40\n",
    "G40 G1 X-5 Y#2\n",
    "G1 X10 Y5\n",
    "G1 X20 Y5\nX20 Y12 (up)\nG3 X10 Y22 I-10 J0\n",
    "G0 Z#1\n",
    "M1\n",
    "G4 P1\n",
    "X-#1\n",
    "X--#1\n",
    "XSIN[30]\n",
    "O",
    "O[#1] call\n",
    "#0=1\n",
    "#5420=1\n",
    "1e9",
    ".",
    "-",
    "M70\n",
    "M71\n",
    "M72\n",
    "M73\n",
    "O6 sub\nM73\nG91 G20 F3 M5\nO6 endsub\nO6 call\n",
    "G61\n",
    "G64 P0.1 Q0.2\n",
    "G93\n",
    "G94\n",
    "M8\n",
    "M9\n",
    "M49\n",
    "G10 L2 P1 X3\n",
    "G10 L2 P0 Y3 R0\n",
    "G10 L20 P2 X1 Y2 Z3\n",
    "G10 L1 P1 R2\n",
    "G52 X1 Y2\n",
    "G52 X0 Y0 Z0\n",
    "G92.1\n",
    "X#5211 Y#5221\n",
    "G53 G0 Z0\n",
    "G28\n",
    "G5 X9 Y1 I1 J2 P1 Q2\n",
    "G5.1 X4 Y5 I3 J1\n",
    "G5.2 X1 Y2 P1\nX3 Y4 P1\nX5 Y6 P2 L4\n",
    "G5.2 P1\n",
    "G5.3\n",
    "G33.1 Z-3 K1\n",
    "G19\n",
    "G51 X1 Y1 P2.\n",
    "G51 X0 Y0 Z0 I-1. J-1.\n",
    "G51.1 X3\n",
    "G50\n",
    "G50.1\n",
    "G68 X1 Y2 R30\n",
    "G68 X0 Y0 R#1\n",
    "G69\n",
    "G65 P7 A1 X2 L2\n",
    "IF [#1 EQ #0] THEN #1=3\n",
    "#1=#0\n",
    "G76 X1 Z-3 R1 I1 P1\n",
    "K2 ",
    "M99 P5\n",
    "G0 X1 Y2 Z3\n",
    "G1 X7 Y8\n",
    "G3 X9 Y8 I1 J0\n",
];

/// A program of a seed.
fn program(seed: u64) -> String {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as usize % below
    };
    let count = 1 + next(24);
    let mut text = String::new();
    if next(3) > 0 {
        text.push_str(PIECES[0]);
    }
    for _ in 0..count {
        text.push_str(PIECES[next(PIECES.len())]);
    }
    // A byte is lost, or comes twice.
    if next(4) == 0 {
        let at = next(text.len());
        if text.is_char_boundary(at) && text.is_char_boundary(at + 1) {
            match next(2) {
                0 => drop(text.remove(at)),
                _ => {
                    let twice = text[at..=at].to_owned();
                    text.insert_str(at, &twice);
                }
            }
        }
    }
    text
}

/// Whether the program of a seed was expanded; an error says what was promised and is not kept.
pub fn check(seed: u64) -> Result<bool, String> {
    let text = program(seed);
    let mut options = ExpandOptions::default();
    options.most_blocks = 500;
    options.tool_diameters_mm.insert(1, 1.5);
    options.reading.of_fanuc_run = seed % 3 == 2;
    options.dialect = [Dialect::Undecided, Dialect::LinuxCnc, Dialect::Fanuc][(seed % 3) as usize];
    if seed.is_multiple_of(2) {
        options.reading.machine_zero_mm = Some(Vector3::new(10.0, 20.0, 30.0));
        options.reading.work_offsets_mm[0] = Some(Vector3::new(1.0, 2.0, 3.0));
    }
    let lines = text.lines().count().max(1);
    let expanded = match expand(text.as_str(), &options, &NoSubprograms) {
        Err(error) if error.line >= 1 && error.line <= lines && !error.reason.is_empty() => {
            let all = expansion_faults(text.as_str(), &options, &NoSubprograms);
            let lines: Vec<usize> = all.iter().map(|fault| fault.line).collect();
            return match lines.contains(&error.line) && lines.is_sorted_by(|a, b| a < b) {
                true => Ok(false),
                false => Err(format!("seed {seed}: {error}, among {lines:?}\n{text}")),
            };
        }
        Err(error) => return Err(format!("seed {seed}: line {}: {error}\n{text}", error.line)),
        Ok(expanded) => expanded,
    };
    let flat = expanded.program.bytes().to_vec();
    match expand_or_faults(text.as_str(), &options, &NoSubprograms) {
        Ok(same) if same.program.bytes() == flat && same.origins == expanded.origins => {}
        other => {
            return Err(format!(
                "seed {seed}: not what expand gives: {other:?}\n{text}"
            ));
        }
    }
    let path = interpret(&expanded.program, &options.reading);
    if path.as_ref() != Ok(&expanded.path) {
        return Err(format!("seed {seed}: another path: {path:?}\n{text}"));
    }
    if expanded.origins.len() != expanded.program.line_count() {
        return Err(format!("seed {seed}: lines without an origin\n{text}"));
    }
    let again = expand(flat.clone(), &options, &NoSubprograms);
    match again {
        Ok(again) if again.program.bytes() == flat => Ok(true),
        other => Err(format!(
            "seed {seed}: the flat program is not plain: {:?}\n{text}\n---\n{}",
            other.map(|e| String::from_utf8_lossy(e.program.bytes()).into_owned()),
            String::from_utf8_lossy(&flat)
        )),
    }
}
