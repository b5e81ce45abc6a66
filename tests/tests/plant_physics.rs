//! scratch
use plant_model::*;
use plant_model::params::*;
use plant_model::analysis::whirl::WhirlMeter;
use system_tests::plants::*;

#[test]
fn bouncing_scratch() {
    for (kc, rtol) in [(1e8,1e-12),(1e8,1e-9),(1e8,1e-6),(1e10,1e-12),(1e10,1e-9),(1e10,1e-6)] {
        let mut p = build(&bouncing(kc), &bouncing_start(), Options{rtol,..Default::default()}).unwrap();
        let mut n=0; let mut last=(0.0,Mode::Flight);
        let t0=std::time::Instant::now();
        p.advance(0.2,&Inputs::default(),&mut |s|{n+=1; last=(s.t_s,s.mode); if rtol==1e-9 {println!("{:.12} {:?}", s.t_s, s.mode)}}).unwrap();
        let s=p.snapshot();
        println!("{kc:e} {rtol:e} n={n} last={last:?} x={:.13e} y={:.13e} res={:e} {:?} {:?}", s.position_m.x,s.position_m.y,p.audit().residual(),p.work(),t0.elapsed());
    }
}
#[test]
fn footnote() {
    let hz = 40.0;
    let start=Start{position_m:V2::new(2e-4,0.0),velocity_m_s:V2::new(0.4,0.0),spin_rad_s:hz*std::f64::consts::TAU,spin_phase_rad:0.0};
    let mut p=build(&footnote_4(),&start,Options::default()).unwrap();
    let mut w=WhirlMeter::new(1e-3);
    let mut ring:f64=0.0; let mut spins=vec![];
    for i in 1..=6000 { let t=i as f64*20e-6; p.advance(t,&Inputs::default(),&mut |_|{}).unwrap();
      let s=p.snapshot(); w.push(s.t_s,s.whirl_angle_rad,s.mode.in_contact(),s.spin_rad_s.max(0.0)); ring=ring.max(s.outer_ring.position.norm()); spins.push((t,s.spin_rad_s/std::f64::consts::TAU)); if i%300==0 {println!("{t:.4} {:?} spin {:.3} r {:.3e}",s.mode,s.spin_rad_s/6.283,s.position_m.norm())}
    }
    let f=w.fastest().unwrap();
    let spin_at=spins.iter().find(|s|s.0>=f.t_s).unwrap().1;
    let t90=spins.iter().find(|s|s.1<0.9*hz).unwrap().0; let t2=spins.iter().find(|s|s.1<2.0).unwrap().0;
    println!("{f:?} spin {spin_at} peak {} ring {ring} stand {} meters {:?} audit {:?} res {:e} {:?}", p.meters().peak_contact_force_n, t2-t90,p.meters(),p.audit(),p.audit().residual(),p.work());
}
