//! x
use kinetostat::*;
use super::machine::*;
use super::bars::Barred;
use nalgebra::Vector3;

pub fn explore() {
    for s in [SMALL, -0.1, -0.12] {
        let m = Orthoglide::default().build().unwrap();
        let p = m.posture(&target([s; 3])).unwrap();
        let u = Vector3::repeat(1.0f64).normalize();
        let kc = p.stiffness().unwrap().cartesian.matrix;
        let kpp = kc.fixed_view::<3, 3>(0, 0).into_owned();
        println!("s {s} K0 {}", (u.transpose() * kpp * u)[0] * 1e-3);
        let list: Vec<f64> = if s == SMALL { vec![-12.0,-9.0,-8.5,-8.0,-6.0, -5.7, -5.5, -5.0,-2.0,-0.01, 0.01, 2.0, 4.0, 4.5, 4.8, 4.9, 5.0, 5.5, 6.0] }
            else if s == -0.1 { vec![-40.0, -25.0, -20.0, -17.1, -17.0, -16.9, -10.0, -0.01, 0.01, 5.0, 9.0, 10.0, 10.2, 10.25, 10.3, 11.0, 12.0] }
            else { vec![-20.0, -11.36, -8.0, -5.0, -4.64, -4.0, -0.01, 0.01, 10.0, 20.0, 23.0, 23.5, 24.0, 25.0] };
        for d in list {
            let pose = target((Vector3::repeat(s) + u * d * 1e-3).into());
            let e = p.wrench_at(&pose);
            print!("{d:8.2} ");
            match e {
                Ok(e) => print!("lumped {:10.5} kN mu {:?} st {} it {} | ", e.wrench.force().dot(&u) * 1e-3, e.margin(), e.stable(), e.residual.iterations),
                Err(e) => print!("{e} | "),
            }
            for (c, n) in [(LinkConvention::TranslationsFirst, 1), (LinkConvention::Bowing, 1), (LinkConvention::Bowing, 2)] {
                let b = Barred::new(&Orthoglide::default(), &target([s; 3]), c, n).unwrap();
                let p = b.mechanism.posture_from_joints(&b.target, b.joints.clone()).unwrap();
                match p.wrench_at(&pose) {
                    Ok(e) => print!("{c:?}{n} {:10.5} mu {:?} st {} it {} | ", e.wrench.force().dot(&u) * 1e-3, e.margin(), e.stable(), e.residual.iterations),
                    Err(e) => print!("{e} | "),
                }
            }
            println!();
        }
    }
}
#[cfg(test)]
mod tests { #[test] fn x() { super::explore() } }
