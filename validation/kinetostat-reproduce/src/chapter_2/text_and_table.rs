//! Cutting forces of chapter 2.

use kinetostat::linalg::SingularValues;
use kinetostat_cutting::{SpindlePoint, force_as_printed, largest_force};
use kinetostat_model::Model;
use nalgebra::{Matrix3, Matrix6};

use crate::chapter_2::library::kienzle;
use crate::{Cause, Contents, Item};

/// A material as printed, and its name in the library.
type Named = (&'static str, &'static str);

const MONEL_400: Named = ("Monel 400", "Monel 400");
const AL_MG_4_5_MN: Named = ("Al Mg 4.5 Mn", "AlMg4.5Mn");

/// Table 2.3: material, chip thickness and width in mm, kN at 1000, 1500 and 2000 m/min.
const TABLE_2_3: [(Named, f64, f64, [&str; 3]); 8] = [
    (MONEL_400, 0.2, 8.0, ["6.97", "6.77", "6.64"]),
    (MONEL_400, 0.2, 16.0, ["13.94", "13.54", "13.28"]),
    (MONEL_400, 1.0, 8.0, ["25.65", "24.93", "24.44"]),
    (MONEL_400, 1.0, 16.0, ["51.30", "49.86", "48.88"]),
    (AL_MG_4_5_MN, 0.2, 8.0, ["2.23", "2.17", "2.12"]),
    (AL_MG_4_5_MN, 0.2, 16.0, ["4.46", "4.34", "4.24"]),
    (AL_MG_4_5_MN, 1.0, 8.0, ["7.70", "7.48", "7.33"]),
    (AL_MG_4_5_MN, 1.0, 16.0, ["15.40", "14.96", "14.66"]),
];

const DOUBLED: &str = "erratum Table 2.3, b=16: the rows of b = 16 mm are twice the rounded ones of b = 8 mm (below: 2 x rounded). Named by thickness h x width b and cutting speed.";

const SPEEDS: [f64; 3] = [1000.0, 1500.0, 2000.0];

pub(crate) fn table_2_3() -> Result<Contents, Cause> {
    let (mut items, mut doubled) = (Vec::new(), Vec::new());
    for ((printed_name, name), thickness, width, printed) in &TABLE_2_3 {
        let law = kienzle(name)?;
        for (speed, printed) in SPEEDS.iter().zip(printed) {
            let name = format!("{printed_name}, {thickness} x {width} mm, {speed} m/min");
            let force = 1e-3 * largest_force(&law, *thickness, *width, *speed);
            items.push(if *width > 8.0 {
                // Half of it, rounded as the row above is, and doubled.
                let half = (100.0 * 0.5 * force).round() / 100.0;
                doubled.push(Item::compared(
                    format!("{name}, 2 x rounded"),
                    printed,
                    2.0 * half,
                    "kN",
                    "",
                ));
                Item::erratum(name, printed, force, "kN", DOUBLED)
            } else {
                Item::compared(name, printed, force, "kN", "")
            });
        }
    }
    items.extend(doubled);
    let literal = 1e-3 * force_as_printed(&kienzle(MONEL_400.1)?, 0.2, 8.0);
    items.push(Item::erratum(
        "Monel 400, 0.2 x 8 mm, by equation 2.4 as printed",
        "6.97",
        literal,
        "kN",
        "erratum 2.4 and Table 2.3: equation 2.4 leaves out the speed; the table follows from 2 k_c b h v^-0.07, v in m/min.",
    ));
    Ok(Contents::of(items))
}

/// Cutting speed, m/min, of a diameter (mm) at so many turns per minute.
fn cutting_speed(diameter_mm: f64, rpm: f64) -> f64 {
    1e-3 * std::f64::consts::PI * diameter_mm * rpm
}

/// Effect of a torque of 10 N m about the axes of least and largest effect, on a robot of the class of the KUKA KR 240: turns in deg
/// and motions in mm.
fn deflections_by_torque() -> Result<[[f64; 2]; 2], Cause> {
    let machine = Model::preset("kuka_kr270_like")?.mechanism;
    let home = machine.platforms()[machine.tool()].home;
    let c: Matrix6<f64> = machine.posture(&home)?.stiffness()?.compliance().springs;
    let extremes = |first: usize, factor: f64| {
        let block: Matrix3<f64> = c.fixed_view::<3, 3>(first, 3).into_owned();
        let sizes = SingularValues::of(&block);
        [factor * sizes.least(), factor * sizes.largest()]
    };
    Ok([extremes(3, 10.0_f64.to_degrees()), extremes(0, 1e4)])
}

pub(crate) fn text_2_2() -> Result<Contents, Cause> {
    let soft = largest_force(&kienzle(AL_MG_4_5_MN.1)?, 0.2, 8.0, 1000.0);
    let hard = largest_force(&kienzle(MONEL_400.1)?, 0.2, 8.0, 1000.0);
    // Half of the rated power, at the spindle's nose.
    let torque = SpindlePoint::of_power(1e4, 0.5 * 20e3).torque_n_m;
    let aluminium = kienzle(AL_MG_4_5_MN.1)?;
    let per_width = |chip: f64| chip * aluminium.specific_n_per_mm2(chip);
    let half_the_chip = per_width(0.1) / per_width(0.2);
    let [turns, motions] = deflections_by_torque()?;
    let about = "erratum 2.2 text: the print is about a thousand times too large. No joint of the class yields by more than 3.4e-6 rad/(N m) (preset kuka_kr270_like, at home).";
    let along = "the preset kuka_kr270_like at home; the report states neither robot nor posture";
    let arm = "erratum 2.2 text: the force of 2 to 7 kN times the offset of 0.1 m; the print is a tenth of it.";
    let items = vec![
        Item::compared("force for Al Mg 4.5 Mn, about", "2", 1e-3 * soft, "kN", ""),
        Item::compared("force for Monel 400, close to", "7", 1e-3 * hard, "kN", ""),
        Item::compared(
            "torque of 20 kW at 10000 turns/min and 50 %, about",
            "10",
            torque,
            "N m",
            "",
        ),
        Item::unprinted(
            "power of that force for Monel 400 at 1000 m/min",
            1e-3 * hard * 1000.0 / 60.0,
            "kW",
            "Nearly six times the 20 kW of that spindle: such a chip is cut at a lower speed.",
        ),
        Item::unprinted(
            "cutting speed of 20 mm at twice 10000 turns/min, as a multiple of that at 10000",
            cutting_speed(20.0, 2e4) / cutting_speed(20.0, 1e4),
            "",
            "erratum 2.2 text: it says that the cutting speed does not change, but v_c = pi D N. What falls with the same feed is the chip, and with it the force.",
        ),
        Item::unprinted(
            "force of a tooth, Al Mg 4.5 Mn, at twice the spindle speed and the same feed, as a share",
            half_the_chip,
            "",
            "Half the chip: the force falls to 2^(m_c - 1) of it, the higher speed aside, as the text says.",
        ),
        Item::erratum(
            "lateral torque of 2 kN at 100 mm",
            "20",
            2e3 * 0.1,
            "N m",
            arm,
        ),
        Item::erratum(
            "lateral torque of 7 kN at 100 mm",
            "140",
            7e3 * 0.1,
            "N m",
            arm,
        ),
        Item::erratum(
            "turn of a KUKA-240 under 10 N m, least",
            "0.1",
            turns[0],
            "deg",
            about,
        ),
        Item::erratum(
            "turn of a KUKA-240 under 10 N m, most",
            "1.6",
            turns[1],
            "deg",
            about,
        ),
        Item::unprinted(
            "motion of a KUKA-240 under 10 N m, most",
            motions[1],
            "mm",
            &format!("printed as 0.001 to 0.008 mm, which is of this size: {along}."),
        ),
    ];
    Ok(Contents::of(items))
}
