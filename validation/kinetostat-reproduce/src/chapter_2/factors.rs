//! Table 2.1: correction factors of the cutting force.

use kinetostat_cutting::{Coolant, Correction, CutError, CuttingMaterial, RakeReference};

use crate::chapter_2::library::material;
use crate::{Cause, Contents, Item};

const SLOPE: &str = "The slope of 0.012 is as printed; 0.015 would fit the usual reference angles better, which the report cannot prove.";

/// A range is no number: what is computed is the middle, and the note says so.
const MIDDLE: &str = "The middle of the printed range is taken where nobody gives another.";

const GIVEN: &str = "Whoever knows the wear gives the factor; here the middle of the range.";

pub(crate) fn table_2_1() -> Result<Contents, Cause> {
    let mut items = vec![process()?];
    items.extend(speed());
    items.extend(rake());
    items.extend(others()?);
    Ok(Contents::of(items))
}

/// Milling with a material that was measured in turning.
fn process() -> Result<Item, CutError> {
    let applied = material("Monel 400")?.for_milling(&Correction::default())?;
    Ok(Item::formula(
        "K_PRO, milling with coefficients of turning tests",
        "1.2 - 1.4",
        0.5 * (1.2 + 1.4),
        applied.law.factor,
        "",
        MIDDLE,
    ))
}

fn speed() -> Vec<Item> {
    let slow = |v: f64| 2.023 / v.powf(0.153);
    let fast = |v: f64| 1.380 / v.powf(0.07);
    let item = |printed: &str, value: f64, v: f64| {
        let name = format!("K_V at {v} m/min");
        Item::formula(name, printed, value, Correction::of_speed(v), "", "")
    };
    let mut items = Vec::new();
    for v in [20.0, 50.0] {
        items.push(item("2.023/v^(0.153)", slow(v), v));
    }
    for v in [200.0, 1000.0, 2000.0] {
        items.push(item("1.380/v^(0.07)", fast(v), v));
    }
    items.push(Item::unprinted(
        "K_V at 100 m/min",
        Correction::of_speed(100.0),
        "",
        "The print leaves 100 m/min itself undefined; its two formulas differ there by 3e-4, and the first is taken.",
    ));
    items
}

fn rake() -> Vec<Item> {
    let lines = [
        ("steel", "1.09 - 0.012 gamma", 1.09, RakeReference::Steel),
        (
            "cast iron",
            "1.03 - 0.012 gamma",
            1.03,
            RakeReference::CastIron,
        ),
    ];
    let mut items = Vec::new();
    for (name, printed, at_zero, reference) in lines {
        for rake in [-6.0, 0.0, 6.0] {
            items.push(Item::formula(
                format!("K_gamma, {name}, rake of {rake} degrees"),
                printed,
                at_zero - 0.012 * rake,
                Correction::of_rake(rake, reference),
                "",
                SLOPE,
            ));
        }
    }
    items
}

/// Edge, wear, coolant and shape of the part.
fn others() -> Result<Vec<Item>, CutError> {
    let none = Correction::default();
    let edge = |cutting_material| Correction {
        cutting_material,
        ..none
    };
    let coolant = |coolant| Correction { coolant, ..none };
    let wear = |wear: f64| Correction {
        wear: Some(wear),
        ..none
    };
    let shape = |shape: f64| Correction {
        workpiece_shape: Some(shape),
        ..none
    };
    let numbers = [
        (
            "K_CM, high-speed steel",
            "1.05",
            edge(CuttingMaterial::HighSpeedSteel),
        ),
        (
            "K_CM, cemented carbide",
            "1.0",
            edge(CuttingMaterial::Carbide),
        ),
        ("K_TW, sharp edge", "1.0", none),
        ("K_CL, dry", "1", coolant(Coolant::Dry)),
        (
            "K_CL, coolant that does not mix with water",
            "0.85",
            coolant(Coolant::Oil),
        ),
        ("K_CL, emulsion", "0.9", coolant(Coolant::Emulsion)),
        ("K_WS, turning outside", "1.0", shape(1.0)),
        ("K_WS, turning inside", "1.2", shape(1.2)),
    ];
    let mut items = Vec::new();
    for (name, printed, correction) in numbers {
        items.push(Item::compared(name, printed, correction.factor()?, "", ""));
    }
    let ceramic = edge(CuttingMaterial::Ceramic).factor()?;
    items.insert(
        2,
        Item::formula("K_CM, ceramic", "0.9 - 0.95", 0.925, ceramic, "", MIDDLE),
    );
    let worn = wear(1.4).factor()?;
    items.insert(
        3,
        Item::formula("K_TW, worn edge", "1.3 - 1.5", 1.4, worn, "", GIVEN),
    );
    Ok(items)
}
