//! How wide text is in a bold type that is wider than most.

/// Advance widths of DejaVu Sans Bold, 1/1000 of its size, from the blank on: what browsers on Linux
/// take, and wider than most.
const ADVANCE: [u16; 95] = [
    348, 456, 521, 838, 696, 1002, 872, 306, 457, 457, 523, 838, 380, 415, 380, 365, 696, 696, 696,
    696, 696, 696, 696, 696, 696, 696, 400, 400, 838, 838, 838, 580, 1000, 774, 762, 734, 830, 683,
    683, 821, 837, 372, 372, 775, 637, 995, 837, 850, 733, 850, 770, 720, 682, 812, 774, 1103, 771,
    724, 725, 457, 365, 457, 838, 500, 500, 675, 716, 593, 716, 678, 435, 716, 712, 343, 343, 665,
    343, 1042, 712, 687, 716, 716, 493, 595, 478, 712, 652, 924, 645, 652, 582, 712, 365, 712, 838,
];

/// Width of text, in the unit of its size.
pub fn bold_width(text: &str, size: f64) -> f64 {
    let units: u32 = text
        .chars()
        .map(|c| match c {
            '\u{202f}' => 200,
            ' '..='~' => u32::from(ADVANCE[c as usize - 32]),
            _ => 1000,
        })
        .sum();
    size * f64::from(units) / 1000.0
}
