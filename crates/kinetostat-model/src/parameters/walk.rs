//! A walk over all numbers of a document, always in the same order: what is listed, and what is changed, is found by its place in
//! this order.

use std::collections::BTreeMap;

/// Visitor of the numbers of a document.
pub(crate) trait Visit {
    /// A key, a name or a component.
    fn enter(&mut self, step: &str);
    /// Back from it.
    fn leave(&mut self);
    /// A number, which may be changed. `written` is false for a factor that the document does not hold.
    fn number(&mut self, value: &mut f64, written: bool);
}

/// Part of a document that contains numbers.
pub(crate) trait Numbers {
    /// Goes to all numbers; `key` is the one under which this is written.
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit);
}

impl Numbers for f64 {
    fn walk(&mut self, _: &'static str, visit: &mut dyn Visit) {
        visit.number(self, true);
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        if let Some(value) = self {
            value.walk(key, visit);
        }
    }
}

impl<T: Numbers> Numbers for Box<T> {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        self.as_mut().walk(key, visit);
    }
}

impl<T: Numbers> Numbers for BTreeMap<String, T> {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        for (name, value) in self {
            step(name, value, key, visit);
        }
    }
}

/// One step on the path, and what is behind it.
pub(crate) fn step(name: &str, value: &mut dyn Numbers, key: &'static str, visit: &mut dyn Visit) {
    visit.enter(name);
    value.walk(key, visit);
    visit.leave();
}

const AXES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Names of the entries of a list.
fn components(key: &str, count: usize) -> &'static [&'static str] {
    match (key, count) {
        ("a_b_c_kuka_deg", _) => &["a", "b", "c"],
        ("w_p_r_fanuc_deg", _) => &["w", "p", "r"],
        ("roll_pitch_yaw_urdf_deg" | "roll_pitch_yaw_urdf_rad", _) => &["roll", "pitch", "yaw"],
        ("quaternion_wxyz", _) => &["w", "x", "y", "z"],
        ("quaternion_xyzw", _) => &["x", "y", "z", "w"],
        ("homes_deg" | "homes_rad", _) => &["1", "2", "3"],
        (_, 2) => &["least", "largest"],
        _ => &AXES,
    }
}

fn entries(list: &mut [f64], key: &'static str, visit: &mut dyn Visit) {
    let names = components(key, list.len());
    for (value, name) in list.iter_mut().zip(names) {
        step(name, value, key, visit);
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        entries(self, key, visit);
    }
}

impl Numbers for Vec<f64> {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        entries(self, key, visit);
    }
}

/// A symmetric matrix: the entries on and above the diagonal; what changes above changes below.
impl<const N: usize> Numbers for [[f64; N]; N] {
    fn walk(&mut self, key: &'static str, visit: &mut dyn Visit) {
        for i in 0..N {
            visit.enter(AXES[i]);
            for j in i..N {
                let before = self[i][j];
                step(AXES[j], &mut self[i][j], key, visit);
                if self[i][j].to_bits() != before.to_bits() {
                    self[j][i] = self[i][j];
                }
            }
            visit.leave();
        }
    }
}

/// Tables by their keys: those with numbers, those whose key is no step of the path (an element's word), and the rest. Every key of
/// a table must stand in one of the lists.
macro_rules! numbers {
    ($($table:ty { $($key:ident),* } through { $($word:ident),* } beside { $($other:ident),* })*) => { $(
        impl $crate::parameters::walk::Numbers for $table {
            fn walk(&mut self, _: &'static str, visit: &mut dyn $crate::parameters::walk::Visit) {
                let Self { $($key,)* $($word,)* $($other: _,)* } = self;
                $( $word.walk(stringify!($word), visit); )*
                $( $crate::parameters::walk::step(stringify!($key), $key, stringify!($key), visit); )*
            }
        }
    )* };
}
pub(crate) use numbers;
