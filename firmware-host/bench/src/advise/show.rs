//! Advice as text.

use super::{ARREST_SHARE, Advice, USEFUL_LAG_DEG};
use crate::report::lines::{Cell, Lines, right, unlined, width, wrapped};
use std::fmt::Write;

/// Rows of name, value and remark under a heading.
struct Page {
    text: String,
    rows: Lines,
}

impl Page {
    fn heading(&mut self, text: &str) {
        self.end_rows();
        let _ = write!(self.text, "\n{text}\n");
    }

    fn row(&mut self, name: &str, value: String, remark: &str) {
        self.rows
            .add_row([Cell::new(name), right(value), Cell::new(remark)]);
    }

    fn end_rows(&mut self) {
        let rows = std::mem::replace(&mut self.rows, unlined()).to_string();
        for line in rows.lines() {
            let _ = writeln!(self.text, "{}", line.trim_end());
        }
    }
}

fn speed(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |v| format!("{v:.4} m/s"))
}

fn milliseconds(value: f64) -> String {
    format!("{:.3} ms", value * 1e3)
}

/// All of it for people.
pub fn text(advice: &Advice) -> String {
    let mut page = Page {
        text: format!("{}\n", advice.title),
        rows: unlined(),
    };
    whirl(&mut page, advice);
    reaction(&mut page, advice);
    noise(&mut page, advice);
    impact(&mut page, advice);
    vibration(&mut page, advice);
    page.heading("Warnings");
    if advice.warnings.is_empty() {
        page.text.push_str("  none\n");
    }
    for w in &advice.warnings {
        for line in [
            format!("  {}: {}", w.key, w.text),
            format!("    do: {}", w.remedy),
        ] {
            let _ = writeln!(page.text, "{}", wrapped(&line, "    ", width()));
        }
    }
    page.heading("Suggested configuration, for a scene");
    for line in advice.supervisor_table.lines() {
        let _ = writeln!(page.text, "{}", narrow(line));
    }
    page.text
}

/// A line of a scene, with its comment broken where it is too long.
fn narrow(line: &str) -> String {
    let indent = match line.find('#') {
        Some(at) => format!("{:at$}# ", ""),
        None => String::new(),
    };
    wrapped(line, &indent, width())
}

fn whirl(page: &mut Page, advice: &Advice) {
    let l = &advice.limits;
    page.heading("Whirl");
    page.row(
        "passive threshold v_t,crit",
        speed(l.passive_threshold_m_s),
        l.passive_threshold_text,
    );
    page.row(
        "lift-off speed",
        speed(Some(l.lift_off_m_s)),
        "below it a full inward force breaks the contact",
    );
    page.row(
        "whirl limit v_lim",
        speed(l.whirl_limit_m_s),
        l.whirl_limit_text,
    );
    if let Some(hz) = l.whirl_limit_hz {
        page.row("whirl frequency there", format!("{hz:.1} Hz"), "");
    }
    if let Some(time) = l.arrest_time_s {
        let name = format!("arrest from {ARREST_SHARE} v_lim");
        page.row(&name, milliseconds(time), "with the best braking force");
    }
}

fn reaction(page: &mut Page, advice: &Advice) {
    let r = &advice.reaction;
    page.heading("Reaction");
    for (name, time, remark) in [
        ("wait for the sample, at most", r.sample_s, ""),
        ("delay", r.delay_s, ""),
        ("hold", r.hold_s, "half a tick"),
        ("amplifier lag", r.lag_s, ""),
        (
            "detect to force",
            r.detect_to_force_s,
            "delay, hold and lag; aim below 1 ms",
        ),
        (
            "worst case",
            r.worst_s,
            "with the longest wait for the sample",
        ),
    ] {
        page.row(name, milliseconds(time), remark);
    }
    for way in &r.ways {
        page.row(
            &format!("way from detection to force at {} m/s", way.speed_m_s),
            format!("{:.1} µm", way.way_m * 1e6),
            &format!("{:.2} clearances", way.way_clearances),
        );
    }
    if let Some(lag) = &advice.lag {
        page.row(
            "lag angle in whirl at v_lim",
            format!("{:.1}°", lag.angle_deg),
            &format!(
                "re-centring drives beyond {:.1}° (atan μ), tangential force brakes to about {USEFUL_LAG_DEG}°",
                lag.friction_angle_deg
            ),
        );
    }
}

fn noise(page: &mut Page, advice: &Advice) {
    let n = &advice.noise;
    page.heading("Noise of the estimated speed");
    for (name, noise_m_s) in [("in flight", n.flight_m_s), ("in contact", n.contact_m_s)] {
        page.row(
            name,
            format!("{:.3} mm/s", noise_m_s * 1e3),
            &format!(
                "{:.2} % of {:.4} m/s; aim below 10 %",
                noise_m_s / n.reference_m_s * 100.0,
                n.reference_m_s
            ),
        );
    }
    page.row(
        "time constant of the observer",
        milliseconds(n.observer_s),
        "with detect to force aim below 1 ms",
    );
    let (most, remark) = match n.sensor_noise_most_m {
        Some(most_m) => (format!("{:.3} µm", most_m * 1e6), "and all below it"),
        None => ("–".to_owned(), ""),
    };
    page.row("most sensor noise at this rate", most, remark);
    let least =
        (n.sample_rate_least_hz).map_or("–".to_owned(), |hz| format!("{:.1} kHz", hz / 1e3));
    page.row("least rate with this sensor noise", least, "");
}

fn impact(page: &mut Page, advice: &Advice) {
    let i = &advice.impact;
    page.heading("Impact");
    page.row(
        "contact unavoidable from the centre above",
        speed(Some(i.unavoidable_m_s)),
        "outward speed",
    );
    page.row(
        "K = μ(1 + e)/(1 − e)",
        format!("{:.3}", i.bounce_gain),
        "backward speed of all bounces per radial speed",
    );
    page.row(
        "worst radial impact, the first alone",
        speed(i.first_m_s),
        "its friction impulse makes v_lim; hard wall",
    );
    page.row(
        "the same on a wall that yields",
        speed(i.first_compliant_m_s),
        "",
    );
    page.row(
        "worst radial impact, with all bounces",
        speed(i.all_bounces_m_s),
        "v_lim/K; braking between bounces adds to it",
    );
    page.row(
        "worst radial impact without help",
        speed(i.passive_m_s),
        "v_t,crit/K; damping between bounces adds to it",
    );
}

fn vibration(page: &mut Page, advice: &Advice) {
    let v = &advice.vibration;
    page.heading("Vibration of the reading that no force changes (runout, bending, noise)");
    let (crossover, remark) = match (v.crossover_hz, v.driving_n_s_m, v.driving_hz) {
        (Some(hz), Some(driving), Some(at_hz)) => (
            format!("{hz:.1} Hz"),
            format!(
                "in flight its force drives faster ones, at most with {driving:.0} N s/m, at {at_hz:.0} Hz"
            ),
        ),
        _ => (
            "–".to_owned(),
            "in flight all are damped that the rate shows".to_owned(),
        ),
    };
    page.row("the supervisor damps up to", crossover, &remark);
    if let (Some(limit_m), Some(hz)) = (v.runout_limit_m, advice.nominal.spin_hz) {
        page.row(
            &format!("most runout at {:.1} Hz", hz.abs()),
            format!("{:.1} µm", limit_m * 1e6),
            "amplitude on one axis; with more the supervisor leaves the rotor to levitation",
        );
    }
}
