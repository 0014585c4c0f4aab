//! Columns of a table of measurements.

use kinetostat::MotionKind;

use crate::axes::Axes;

/// Meaning of a column; numbers are factors to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Column {
    Posture,
    Note,
    Branch,
    Axis(usize, f64),
    Force(usize, f64),
    Moment(usize, f64),
    Mass,
    LoadOn,
    LoadAt(usize, f64),
    MarkerOn,
    Marker(usize, f64),
    Displacement(usize, f64),
    Position(usize, f64),
    Turn(usize, f64),
    Gauge(f64),
    GaugeDirection(usize),
    Deviation(f64),
    TurnDeviation(f64),
}

impl Column {
    /// True for a column of words; the others hold numbers.
    pub fn is_word(self) -> bool {
        matches!(
            self,
            Self::Posture | Self::Note | Self::Branch | Self::LoadOn | Self::MarkerOn
        )
    }
}

/// All columns but those of the axes, with what they hold: for help and documentation.
pub const COLUMNS: &str = "posture: name of the posture (rows with the same name share its errors)
A1_deg, A2_deg, ...: axes as the controller shows them, or the model's joints (_deg, _rad, _mm, _m)
fx_n, fy_n, fz_n: force, base axes (_n, _kn)
mx_n_m, my_n_m, mz_n_m: moment, base axes
mass_kg: mass that hangs on the machine
load_on: node or body of a limb on which the load acts, as NODE or LIMB:NODE (the tool without it)
load_x_mm, load_y_mm, load_z_mm: where force and mass act, in the frame of the tool or node (its origin without these)
marker_on: node or body on which the marker is, as load_on
marker_x_mm, marker_y_mm, marker_z_mm: the point that is read, in the frame of the tool or node (its origin without these)
dx_mm, dy_mm, dz_mm: displacement of that point by the load, base axes (_m, _mm, _um)
x_mm, y_mm, z_mm: place of that point, base axes, loaded and, in a row with loads of zero, unloaded
rx_mrad, ry_mrad, rz_mrad: turn of the tool or node by the load, base axes (_rad, _mrad, _urad, _deg)
gauge_mm, gauge_x, gauge_y, gauge_z: reading of a dial gauge and the direction in which it counts up, base axes
sigma_mm: standard deviation of the lengths of this row; sigma_r_mrad: that of the turns
branch: loading or unloading, of a load that is put on in steps and taken off again
note: anything";

/// Endings of a heading with their units in SI.
type Units = [(&'static str, f64)];
type Make = fn(usize, f64) -> Column;

const LENGTHS: [(&str, f64); 3] = [("_m", 1.0), ("_mm", 1e-3), ("_um", 1e-6)];
const TURNS: [(&str, f64); 4] = [
    ("_rad", 1.0),
    ("_mrad", 1e-3),
    ("_urad", 1e-6),
    ("_deg", std::f64::consts::PI / 180.0),
];
const FORCES: [(&str, f64); 2] = [("_n", 1.0), ("_kn", 1e3)];
const MOMENTS: [(&str, f64); 2] = [("_n_m", 1.0), ("_kn_m", 1e3)];

/// Reason why a heading is no column.
pub(crate) enum NoColumn {
    /// The quantity is known, the unit missing or another one: units that it can have.
    Unit(Vec<String>),
    /// The quantity is not known.
    Unknown,
}

/// Column of a heading.
pub(crate) fn column_of(head: &str, axes: &Axes<'_>) -> Result<Column, NoColumn> {
    let head = head.trim();
    for (i, (name, kind)) in axes.names().iter().enumerate() {
        let units = match kind {
            MotionKind::Prismatic => &LENGTHS[..2],
            MotionKind::Revolute => &[TURNS[3], TURNS[0]],
        };
        if let Some(found) = with_unit(head, name, units) {
            return found.map(|unit| Column::Axis(i, unit));
        }
    }
    match head {
        "posture" => return Ok(Column::Posture),
        "note" => return Ok(Column::Note),
        "branch" => return Ok(Column::Branch),
        "mass_kg" => return Ok(Column::Mass),
        "load_on" => return Ok(Column::LoadOn),
        "marker_on" => return Ok(Column::MarkerOn),
        "gauge_x" => return Ok(Column::GaugeDirection(0)),
        "gauge_y" => return Ok(Column::GaugeDirection(1)),
        "gauge_z" => return Ok(Column::GaugeDirection(2)),
        _ => {}
    }
    let vectors: [(&str, &Units, Make); 7] = [
        ("f", &FORCES, Column::Force),
        ("m", &MOMENTS, Column::Moment),
        ("load_", &LENGTHS, Column::LoadAt),
        ("marker_", &LENGTHS, Column::Marker),
        ("d", &LENGTHS, Column::Displacement),
        ("", &LENGTHS, Column::Position),
        ("r", &TURNS, Column::Turn),
    ];
    for (before, units, make) in vectors {
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            if let Some(found) = with_unit(head, &format!("{before}{axis}"), units) {
                return found.map(|unit| make(k, unit));
            }
        }
    }
    for (name, units, make) in [
        ("gauge", &LENGTHS[..], Column::Gauge as fn(f64) -> Column),
        ("sigma_r", &TURNS, Column::TurnDeviation),
        ("sigma", &LENGTHS, Column::Deviation),
        ("mass", &[("_kg", 1.0)], |_| Column::Mass),
    ] {
        if let Some(found) = with_unit(head, name, units) {
            return found.map(make);
        }
    }
    Err(NoColumn::Unknown)
}

/// The factor of `name` with one of the units; none if the heading is another quantity.
fn with_unit(head: &str, name: &str, units: &[(&str, f64)]) -> Option<Result<f64, NoColumn>> {
    let rest = head.strip_prefix(name)?;
    match units.iter().find(|(unit, _)| *unit == rest) {
        Some((_, factor)) => Some(Ok(*factor)),
        // `r` is no turn without its unit but the beginning of another word.
        None if rest.is_empty() => Some(Err(NoColumn::Unit(
            units.iter().map(|(u, _)| format!("{name}{u}")).collect(),
        ))),
        None => None,
    }
}
