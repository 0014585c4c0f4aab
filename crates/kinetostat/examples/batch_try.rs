//! Scratch.
use kinetostat::batch::Batch;
use kinetostat::*;
use nalgebra::*;
fn main() {
    let sec = |d: f64, i: f64| { let a = std::f64::consts::PI/4.0*(d*d-i*i); let iy = std::f64::consts::PI/64.0*(d.powi(4)-i.powi(4)); BeamSection { youngs_modulus: 2.1e11, shear_modulus: 2.1e11/2.6, area: a, second_moment_y: iy, second_moment_z: iy, torsion_constant: 2.0*iy } };
    let l = [[0.35, 0., 0.75], [0., 0., 1.25], [0.55, 0., -0.055], [0.55, 0., 0.], [0.23, 0., 0.], [0.15, 0., 0.10]];
    let ka = [3.8e6, 6.6e6, 3.9e6, 5.6e5, 6.6e5, 4.7e5];
    let dims = [(0.40, 0.36), (0.32, 0.28), (0.26, 0.23), (0.22, 0.19), (0.16, 0.13), (0.12, 0.08)];
    let axes = [2usize, 1, 1, 0, 1, 0];
    let mut b = Chain::builder("arm");
    for i in 0..6 {
        let mut ax = Vector3::zeros(); ax[axes[i]] = 1.0;
        b = b.actuator(&format!("j{i}"), ActuatorSpec { home: 0.0, ..ActuatorSpec::new(MotionKind::Revolute, ax, ka[i]) });
        let v = Vector3::from(l[i]);
        let k = sec(dims[i].0, dims[i].1).cantilever(v.norm());
        let x = v.normalize(); let h = if x.z.abs() < 0.9 { Vector3::z() } else { Vector3::y() }; let y = h.cross(&x).normalize(); let z = x.cross(&y);
        let r = Matrix3::from_columns(&[x, y, z]); let mut bb = Matrix6::zeros(); bb.fixed_view_mut::<3,3>(0,0).copy_from(&r); bb.fixed_view_mut::<3,3>(3,3).copy_from(&r);
        b = b.translation(v).spring6(&format!("l{i}"), &(bb * k * bb.transpose()), [0.0; 6]);
    }
    let chain = b.build().unwrap();
    let m = Mechanism::serial(chain, Pose::translation(1.0, 0.0, 1.0), Vector3::zeros()).unwrap();
    let batch = Batch::new(&m);
    println!("alone: {:?}", batch.alone());
    let n = std::env::args().nth(1).and_then(|x| x.parse().ok()).unwrap_or(4096);
    let q: Vec<f64> = (0..6 * n).map(|i| ((i as f64) * 0.618_033_9).fract() * 3.0 - 1.5).collect();
    let mut best = f64::MAX;
    let mut out = batch.stiffness_at_joints(&q, true).unwrap();
    for _ in 0..200 { let t = std::time::Instant::now(); out = batch.stiffness_at_joints(&q, true).unwrap(); best = best.min(t.elapsed().as_secs_f64()); }
    println!("W1 {:.4} us", best / n as f64 * 1e6);
    let mut worst = 0.0_f64;
    for i in (0..n).step_by(37) {
        let target = unloaded_tip(&m.limbs()[0].nominal, &Pose::identity(), &[0.0; 42], &q[6*i..6*i+6]);
        let p = m.posture_from_joints(&target, vec![LimbPosture { commands: q[6*i..6*i+6].to_vec(), coordinates: vec![0.0; 42] }]).unwrap();
        let k = p.stiffness().unwrap().cartesian.matrix;
        let mine = Matrix6::from_fn(|r, c| out.stiffness.get(i, 6*r+c));
        worst = worst.max((k - mine).amax() / k.amax());
    }
    println!("W1 worst {worst:e}");
    // W2
    let deg = f64::to_radians;
    let pb = [-10.0, 10., 110., 130., 230., 250.].map(deg); let pp = [-50.0, 50., 70., 170., 190., 290.].map(deg);
    let home = Pose::translation(0.0, 0.0, 0.9);
    let mut mb = Mechanism::builder("stewart");
    let tool = mb.platform(Platform::new("tool", home));
    let kl = sec(0.06, 0.04).cantilever(0.95);
    let r = Matrix3::new(0.,0.,-1., 0.,1.,0., 1.,0.,0.) ;
    let mut bb = Matrix6::zeros(); bb.fixed_view_mut::<3,3>(0,0).copy_from(&r); bb.fixed_view_mut::<3,3>(3,3).copy_from(&r);
    let kz = bb * kl * bb.transpose();
    for i in 0..6 {
        let base = Vector3::new(0.6 * pb[i].cos(), 0.6 * pb[i].sin(), 0.0); let plat = Vector3::new(0.35 * pp[i].cos(), 0.35 * pp[i].sin(), 0.0);
        let chain = Chain::builder(format!("leg{i}")).translation(base)
            .passive("u1", MotionKind::Revolute, Vector3::x(), 0.0).passive("u2", MotionKind::Revolute, Vector3::y(), 0.0)
            .actuator("ram", ActuatorSpec { home: 0.95, ..ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 4e7) })
            .spring6("strut", &kz, [0.0; 6]).passive_spherical("s").translation(-plat).build().unwrap();
        mb = mb.limb(Limb { name: format!("leg{i}"), from: 0, to: tool, platform_from_tip: Pose::identity(), nominal: chain.clone(), actual: chain });
    }
    let m = mb.build().unwrap();
    let batch = Batch::new(&m);
    println!("alone: {:?}", batch.alone());
    let f = |i: usize, k: usize| (((i * 7 + k) as f64) * 0.618_033_9).fract() * 2.0 - 1.0;
    let poses: Vec<Pose> = (0..n).map(|i| { let e = 15f64.to_radians(); Pose::from_parts(Vector3::new(0.12*f(i,0), 0.12*f(i,1), 0.9+0.1*f(i,2)).into(), UnitQuaternion::from_axis_angle(&Vector3::x_axis(), e*f(i,3)) * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), e*f(i,4)) * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), e*f(i,5))) }).collect();
    let mut out = batch.stiffness(&poses);
    let together = out.found.iter().filter(|f| **f == kinetostat::batch::Found::Together).count();
    println!("together {together} of {n}");
    for k in 0..6 { println!("{:?}", (0..6).map(|c| out.stiffness.get(0, 6*k+c)).collect::<Vec<_>>()); }
    let mut best = f64::MAX;
    for _ in 0..200 { let t = std::time::Instant::now(); out = batch.stiffness(&poses); best = best.min(t.elapsed().as_secs_f64()); }
    println!("W2 {:.4} us", best / n as f64 * 1e6);
    let mut worst = 0.0_f64;
    for i in (0..n).step_by(37) {
        let k = m.posture(&poses[i]).unwrap().stiffness().unwrap().cartesian.matrix;
        let mine = Matrix6::from_fn(|r, c| out.stiffness.get(i, 6*r+c));
        worst = worst.max((k - mine).amax() / k.amax());
    }
    println!("W2 worst {worst:e}");

    w3(n); w4(n);
}
fn rnd(i: usize) -> f64 { ((i as f64 + 1.0) * 0.618_033_988_7).fract() * 2.0 - 1.0 }
fn w3(n: usize) {
    let sec = |d: f64, i: f64| { let a = std::f64::consts::PI/4.0*(d*d-i*i); let iy = std::f64::consts::PI/64.0*(d.powi(4)-i.powi(4)); BeamSection { youngs_modulus: 2.1e11, shear_modulus: 2.1e11/2.6, area: a, second_moment_y: iy, second_moment_z: iy, torsion_constant: 2.0*iy } };
    let l = [[0.35, 0., 0.75], [0., 0., 1.25], [0.55, 0., -0.055], [0.55, 0., 0.], [0.23, 0., 0.], [0.15, 0., 0.10]];
    let ka = [3.8e6, 6.6e6, 3.9e6, 5.6e5, 6.6e5, 4.7e5];
    let dims = [(0.40, 0.36), (0.32, 0.28), (0.26, 0.23), (0.22, 0.19), (0.16, 0.13), (0.12, 0.08)];
    let mass = [330., 270., 190., 90., 35., 25.];
    let axes = [2usize, 1, 1, 0, 1, 0];
    let mut b = Chain::builder("arm");
    for i in 0..6 {
        let mut ax = Vector3::zeros(); ax[axes[i]] = 1.0;
        b = b.actuator(&format!("j{i}"), ActuatorSpec { home: 0.0, ..ActuatorSpec::new(MotionKind::Revolute, ax, ka[i]) });
        let v = Vector3::from(l[i]);
        let k = sec(dims[i].0, dims[i].1).cantilever(v.norm());
        let x = v.normalize(); let h = if x.z.abs() < 0.9 { Vector3::z() } else { Vector3::y() }; let y = h.cross(&x).normalize(); let z = x.cross(&y);
        let r = Matrix3::from_columns(&[x, y, z]); let mut bb = Matrix6::zeros(); bb.fixed_view_mut::<3,3>(0,0).copy_from(&r); bb.fixed_view_mut::<3,3>(3,3).copy_from(&r);
        b = b.translation(v).spring6(&format!("l{i}"), &(bb * k * bb.transpose()), [0.0; 6]).body(&format!("m{i}"), mass[i], -0.5 * v, Matrix3::zeros());
    }
    let chain = b.build().unwrap();
    let m = Mechanism::serial(chain, Pose::translation(1.0, 0.0, 1.0), Vector3::new(0., 0., -9.81)).unwrap();
    let batch = Batch::new(&m);
    let q: Vec<f64> = (0..6 * n).map(|i| ((i as f64) * 0.618_033_9).fract() * 3.0 - 1.5).collect();
    let wr: Vec<Wrench> = (0..n).map(|i| { let f = Vector3::new(rnd(7*i), rnd(7*i+2), rnd(7*i+5)).normalize() * 2000.0; let t = Vector3::new(rnd(11*i), rnd(11*i+2), rnd(11*i+5)).normalize() * 300.0; Wrench::new(f, t) }).collect();
    for tangent in [false, true] {
        let mut best = f64::MAX; let mut out = batch.equilibrium_at_joints(&q, &wr, tangent).unwrap();
        for _ in 0..100 { let t = std::time::Instant::now(); out = batch.equilibrium_at_joints(&q, &wr, tangent).unwrap(); best = best.min(t.elapsed().as_secs_f64()); }
        let together = out.found.iter().filter(|f| **f == kinetostat::batch::Found::Together).count();
        println!("W3 tangent {tangent} {:.4} us, together {together}", best / n as f64 * 1e6);
        let (mut worst, mut worst_k) = (0.0_f64, 0.0_f64);
        for i in (0..n).step_by(37) {
            let target = unloaded_tip(&m.limbs()[0].nominal, &Pose::identity(), &[0.0; 42], &q[6*i..6*i+6]);
            let p = m.posture_from_joints(&target, vec![LimbPosture { commands: q[6*i..6*i+6].to_vec(), coordinates: vec![0.0; 42] }]).unwrap();
            let e = p.deflected_by(&wr[i]).unwrap();
            let d = (Vector3::from_fn(|k, _| out.tool.get(i, 9 + k)) - e.tool.translation.vector).norm();
            worst = worst.max(d);
            if tangent { let mine = Matrix6::from_fn(|r, c| out.stiffness.get(i, 6*r+c)); worst_k = worst_k.max((e.stiffness.matrix - mine).amax() / mine.amax()); }
        }
        println!("W3 worst {worst:e} m, K {worst_k:e}");
    }
}
fn w4(n: usize) {
    let sec = |d: f64, i: f64| { let a = std::f64::consts::PI/4.0*(d*d-i*i); let iy = std::f64::consts::PI/64.0*(d.powi(4)-i.powi(4)); BeamSection { youngs_modulus: 2.1e11, shear_modulus: 2.1e11/2.6, area: a, second_moment_y: iy, second_moment_z: iy, torsion_constant: 2.0*iy } };
    let bs = [Matrix3::identity(), Matrix3::new(0.,0.,1.,1.,0.,0.,0.,1.,0.), Matrix3::new(0.,1.,0.,0.,0.,1.,1.,0.,0.)];
    let mut mb = Mechanism::builder("puu");
    let tool = mb.platform(Platform::new("tool", Pose::identity()));
    for i in 0..3 {
        let rot = |r: &Matrix3<f64>| Pose::from_parts(Vector3::zeros().into(), UnitQuaternion::from_matrix(r));
        let home = -0.34;
        let chain = Chain::builder(format!("leg{i}")).rigid(rot(&bs[i]))
            .actuator("slide", ActuatorSpec { home: home, ..ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 2.8e6) })
            .spring6("foot", &sec(0.04, 0.0).cantilever(0.08), [0.0; 6])
            .passive("q1", MotionKind::Revolute, Vector3::z(), 0.0).passive("q2", MotionKind::Revolute, Vector3::y(), 0.0)
            .translation(Vector3::new(0.31, 0., 0.)).spring6("bar", &sec(0.022, 0.014).cantilever(0.31), [0.0; 6])
            .passive("q3", MotionKind::Revolute, Vector3::y(), 0.0).passive("q4", MotionKind::Revolute, Vector3::z(), 0.0)
            .translation(Vector3::new(0.03, 0., 0.)).rigid(rot(&bs[i].transpose())).build().unwrap();
        mb = mb.limb(Limb { name: format!("leg{i}"), from: 0, to: tool, platform_from_tip: Pose::identity(), nominal: chain.clone(), actual: chain });
    }
    let m = mb.build().unwrap();
    let batch = Batch::new(&m);
    println!("alone: {:?}", batch.alone());
    let poses: Vec<Pose> = (0..n).map(|i| Pose::translation(0.09 * rnd(3*i), 0.09 * rnd(3*i+1), 0.09 * rnd(3*i+2))).collect();
    let wr: Vec<Wrench> = (0..n).map(|i| { let f = Vector3::new(rnd(7*i), rnd(7*i+2), rnd(7*i+5)).normalize() * 300.0; let t = Vector3::new(rnd(11*i), rnd(11*i+2), rnd(11*i+5)).normalize() * 10.0; Wrench::new(f, t) }).collect();
    let out = batch.stiffness(&poses);
    let together = out.found.iter().filter(|f| **f == kinetostat::batch::Found::Together).count();
    println!("3-PUU unloaded together {together}");
    let mut worst_k = 0.0_f64;
    for i in (0..n).step_by(37) { let e = m.posture(&poses[i]).unwrap().stiffness().unwrap().cartesian.matrix; let mine = Matrix6::from_fn(|r, c| out.stiffness.get(i, 6*r+c)); worst_k = worst_k.max((e - mine).amax() / mine.amax()); }
    println!("3-PUU K {worst_k:e}");
    let mut best = f64::MAX; let mut out = batch.equilibrium(&poses, &wr, false).unwrap();
    for _ in 0..100 { let t = std::time::Instant::now(); out = batch.equilibrium(&poses, &wr, false).unwrap(); best = best.min(t.elapsed().as_secs_f64()); }
    let together = out.found.iter().filter(|f| **f == kinetostat::batch::Found::Together).count();
    println!("W4 {:.4} us, together {together}", best / n as f64 * 1e6);
    let mut worst = 0.0_f64;
    for i in (0..n).step_by(37) {
        let e = m.posture(&poses[i]).unwrap().deflected_by(&wr[i]).unwrap();
        let d = (Vector3::from_fn(|k, _| out.tool.get(i, 9 + k)) - e.tool.translation.vector).norm();
        worst = worst.max(d);
    }
    println!("W4 worst {worst:e} m");
}
