//! Table 2.2: specific cutting forces of typical high performance materials.

use crate::chapter_2::library::kienzle;
use crate::{Cause, Contents, Item};

/// Name as printed, name in the library, `k_c1.1` (N/mm^2) and `m_c` as printed.
pub(crate) const TABLE_2_2: [(&str, &str, &str, &str); 4] = [
    ("Monel 400", "Monel 400", "2600", "0.19"),
    ("Inconell 718", "Inconel 718", "2088", "0.29"),
    ("Ti Al 6 V 4", "Ti-6Al-4V", "1370", "0.21"),
    ("Al Mg 4.5 Mn", "AlMg4.5Mn", "780", "0.23"),
];

const NAMES: &str = "The print has k_i1.1 and calls it a cutting power; it is k_c1.1, a specific cutting force. The name is Inconel 718.";

/// The library's numbers beside the printed ones, and what they say of a chip of 0.2 mm.
pub(crate) fn table_2_2() -> Result<Contents, Cause> {
    let mut items = Vec::new();
    for (printed_name, name, specific, exponent) in TABLE_2_2 {
        let law = kienzle(name)?;
        // At a chip of 1 mm the law is its first coefficient; from there to a tenth it falls by the second.
        let at_one = law.specific_n_per_mm2(1.0);
        let slope = (law.specific_n_per_mm2(0.1) / at_one).log10();
        items.push(Item::compared(
            format!("{printed_name}: k_c1.1"),
            specific,
            at_one,
            "N/mm^2",
            NAMES,
        ));
        items.push(Item::compared(
            format!("{printed_name}: m_c"),
            exponent,
            slope,
            "",
            "",
        ));
        items.push(Item::unprinted(
            format!("{printed_name}: k_c at h = 0.2 mm, by equation 2.2"),
            law.specific_n_per_mm2(0.2),
            "N/mm^2",
            "",
        ));
    }
    Ok(Contents::of(items))
}
