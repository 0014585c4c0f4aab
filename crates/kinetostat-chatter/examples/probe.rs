use kinetostat_chatter::*;
fn main() {
    let mode = Mode::along([1.0, 0.0, 0.0].into(), 0.03993, 922.0, 0.011).unwrap();
    let cut = MillingCut::new(2, Arc::slot(), Coefficients::new(6e8, 2e8, 0.0).unwrap()).unwrap();
    let slot = Regeneration::new(ToolResponse::new(vec![mode]).unwrap(), cut.into()).unwrap();
    for f in [0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.5,3.0] {
        let v: Vec<String> = [(5000.0, 0.2e-3), (5000.0, 1e-3), (7000.0, 1.15e-3), (21000.0, 2.256e-3), (2000.0, 0.3e-3)].iter().map(|(s, d)| format!("{:.10}", slot.multiplier_with(*s, *d, f).unwrap().size())).collect();
        println!("{f} {v:?}");
    }
}
