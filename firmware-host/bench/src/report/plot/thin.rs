//! Traces reduced to what the pixels of a figure can show, so that peaks and brief events survive.

/// A closed interval with finite ends, lo ≤ hi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
}

/// A stretch of time in one class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Band {
    pub(crate) class: usize,
    pub(crate) span: Interval,
}

/// A stretch of a path, all in contact or all in flight.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) touching: bool,
    pub(crate) points: Vec<(f64, f64)>,
}

/// A point of a path: (x, y, in contact).
pub(crate) type PathPoint = (f64, f64, bool);

/// Whether a value can stand on an axis. The bound keeps sums and squares of values finite.
pub(crate) fn drawable(v: f64) -> bool {
    v.abs() < 1e12
}

impl Interval {
    /// From `-reach` to `reach`, either sign.
    pub(crate) fn symmetric(reach: f64) -> Self {
        Self {
            lo: -reach.abs(),
            hi: reach.abs(),
        }
    }

    /// Smallest interval with all values that can be drawn; `None` without any.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let points = values.into_iter().filter(|v| drawable(*v));
        points.map(|v| Self { lo: v, hi: v }).reduce(Self::with)
    }

    /// Smallest interval around both.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// Common part, if any.
    pub(crate) fn within(self, other: Self) -> Option<Self> {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        (lo <= hi).then_some(Self { lo, hi })
    }

    pub(crate) fn size(self) -> f64 {
        self.hi - self.lo
    }

    pub(crate) fn middle(self) -> f64 {
        0.5 * (self.lo + self.hi)
    }

    pub(crate) fn contains(self, v: f64) -> bool {
        (self.lo..=self.hi).contains(&v)
    }

    /// Largest absolute value.
    pub(crate) fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// Widened by `share` of its size, and never so narrow that an axis would show rounding errors.
    pub(crate) fn widened(self, share: f64) -> Self {
        let room = (share * self.size())
            .max(0.005 * self.magnitude())
            .max(1e-6);
        Self {
            lo: self.lo - room,
            hi: self.hi + room,
        }
    }
}

/// Extremes of the points in one column.
struct Extremes {
    column: usize,
    low: (f64, f64),
    high: (f64, f64),
}

/// Lowest and highest of the points in each of `columns` columns of the window, in time order: a line
/// through them covers the same pixels as a line through all.
pub(crate) fn thinned(
    points: impl Iterator<Item = (f64, f64)>,
    window: Interval,
    columns: usize,
) -> Vec<(f64, f64)> {
    let mut all: Vec<Extremes> = Vec::new();
    for point in points.filter(|p| window.contains(p.0) && drawable(p.1)) {
        let column = column(point.0, window, columns);
        match all.last_mut().filter(|last| last.column == column) {
            Some(last) => last.extend_to(point),
            None => all.push(Extremes {
                column,
                low: point,
                high: point,
            }),
        }
    }
    all.iter().flat_map(Extremes::in_time_order).collect()
}

impl Extremes {
    fn extend_to(&mut self, point: (f64, f64)) {
        if point.1 < self.low.1 {
            self.low = point;
        }
        if point.1 > self.high.1 {
            self.high = point;
        }
    }

    fn in_time_order(&self) -> impl Iterator<Item = (f64, f64)> {
        let (first, second) = if self.low.0 <= self.high.0 {
            (self.low, self.high)
        } else {
            (self.high, self.low)
        };
        [Some(first), (first != second).then_some(second)]
            .into_iter()
            .flatten()
    }
}

/// Column of a time; the casts saturate, so that every time has one.
fn column(t: f64, window: Interval, columns: usize) -> usize {
    let at = (t - window.lo) / window.size() * columns as f64;
    (at as usize).min(columns.saturating_sub(1))
}

/// At most one band in each column of the window. Where several share a column the class that is
/// rarest in the window stays, because it is the brief ones that a reader would otherwise miss.
pub(crate) fn one_band_a_column(bands: &[Band], window: Interval, columns: usize) -> Vec<Band> {
    let visible = |band: &Band| Some((band.class, band.span.within(window)?));
    let classes = bands.iter().map(|band| band.class + 1).max().unwrap_or(0);
    let mut total = vec![0.0; classes];
    for (class, span) in bands.iter().filter_map(visible) {
        total[class] += span.size();
    }
    let mut winner: Vec<Option<usize>> = vec![None; columns];
    for (class, span) in bands.iter().filter_map(visible) {
        let first = column(span.lo, window, columns);
        // A band that ends on the edge of a column has no part in it.
        let end = ((span.hi - window.lo) / window.size() * columns as f64).ceil() as usize;
        for slot in winner.iter_mut().take(end.max(first + 1)).skip(first) {
            if slot.is_none_or(|other| total[class] < total[other]) {
                *slot = Some(class);
            }
        }
    }
    joined(&winner, window)
}

/// Bands of columns: neighbours of one class become one.
fn joined(winner: &[Option<usize>], window: Interval) -> Vec<Band> {
    let width = window.size() / winner.len().max(1) as f64;
    let edge = |i: usize| window.lo + i as f64 * width;
    let mut out: Vec<Band> = Vec::new();
    for (i, class) in winner.iter().enumerate() {
        let Some(class) = *class else {
            continue;
        };
        match out.last_mut() {
            Some(last) if last.class == class && last.span.hi == edge(i) => {
                last.span.hi = edge(i + 1);
            }
            _ => {
                let span = Interval {
                    lo: edge(i),
                    hi: edge(i + 1),
                };
                out.push(Band { class, span });
            }
        }
    }
    out
}

/// The path on axes that span ± `reach` over `pixels` pixels, without what no reader would see: steps
/// of less than a third of a pixel and pixels that are drawn already. A thousand turns on one circle
/// look like one. Coarser where it would take more than `bytes` of SVG.
pub(crate) fn trail(path: &[PathPoint], reach: f64, pixels: f64, bytes: usize) -> Vec<Stretch> {
    let mut cell = 2.0 * reach / pixels;
    let mut stretches = fresh_stretches(path, Canvas::new(reach, cell));
    while stretches.iter().map(Stretch::cost).sum::<usize>() > bytes && cell < reach {
        cell *= 1.25;
        stretches = fresh_stretches(path, Canvas::new(reach, cell));
    }
    stretches
}

impl Stretch {
    /// Bytes of SVG on a canvas of about a thousand units: an element and its points.
    fn cost(&self) -> usize {
        ELEMENT_BYTES + POINT_BYTES * self.points.len()
    }
}

const POINT_BYTES: usize = 9;
const ELEMENT_BYTES: usize = 100;

fn fresh_stretches(path: &[PathPoint], mut canvas: Canvas) -> Vec<Stretch> {
    let step = 0.33 * canvas.cell;
    let mut out: Vec<Stretch> = Vec::new();
    // Drawn already, but shorter to repeat than to begin a new element for what follows.
    let mut repeated: Vec<(f64, f64)> = Vec::new();
    let mut open = false;
    let mut points = path.iter().filter(|p| drawable(p.0) && drawable(p.1));
    let Some(mut from) = points.next() else {
        return out;
    };
    for to in points {
        // Changes of contact stay, however short the step.
        if (to.0 - from.0).hypot(to.1 - from.1) < step && to.2 == from.2 {
            continue;
        }
        let (begin, end) = ((from.0, from.1), (to.0, to.1));
        let fresh = canvas.mark(begin, end, from.2);
        let last = out
            .last_mut()
            .filter(|last| open && last.touching == from.2);
        match last {
            Some(last) if fresh => {
                last.points.append(&mut repeated);
                last.points.push(end);
            }
            Some(_) if repeated.len() * POINT_BYTES < ELEMENT_BYTES => repeated.push(end),
            _ => {
                repeated.clear();
                open = fresh;
                if fresh {
                    out.push(Stretch {
                        touching: from.2,
                        points: vec![begin, end],
                    });
                }
            }
        }
        from = to;
    }
    out
}

/// Which cells of a square have been drawn on, in flight and in contact.
struct Canvas {
    reach: f64,
    cell: f64,
    side: usize,
    drawn: Vec<[bool; 2]>,
    /// Cell that the pen is in, and the length that may still be drawn there as new.
    pen: (usize, f64),
}

impl Canvas {
    fn new(reach: f64, cell: f64) -> Self {
        // The cast saturates; a quotient that is no number becomes one cell.
        let side = ((2.0 * reach / cell).ceil().min(4096.0) as usize).max(1);
        Self {
            reach,
            cell,
            side,
            drawn: vec![[false; 2]; side * side],
            pen: (usize::MAX, 0.0),
        }
    }

    /// Draws a line; whether any of it is new.
    fn mark(&mut self, from: (f64, f64), to: (f64, f64), touching: bool) -> bool {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        let steps = (length / self.cell).ceil().clamp(1.0, 4096.0) as u32;
        let mut fresh = false;
        // The start belongs to the line before.
        for i in 1..=steps {
            let part = f64::from(i) / f64::from(steps);
            let at = self.index(from.1 + part * dy) * self.side + self.index(from.0 + part * dx);
            fresh |= self.mark_cell(at, touching, length / f64::from(steps));
        }
        fresh
    }

    /// A cell stays new while the pen crosses it, but not for ever: a rotor that trembles in one cell
    /// would fill any file.
    fn mark_cell(&mut self, at: usize, touching: bool, length: f64) -> bool {
        let drawn = &mut self.drawn[at][usize::from(touching)];
        if !*drawn {
            *drawn = true;
            self.pen = (at, 3.0 * self.cell);
        } else if self.pen.0 == at {
            self.pen.1 -= length;
        } else {
            self.pen = (at, 0.0);
        }
        self.pen.1 > 0.0
    }

    fn index(&self, v: f64) -> usize {
        (((v + self.reach) / self.cell) as usize).min(self.side - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Interval = Interval { lo: 0.0, hi: 10.0 };

    fn band(class: usize, lo: f64, hi: f64) -> Band {
        Band {
            class,
            span: Interval { lo, hi },
        }
    }

    #[test]
    fn thinning_keeps_peaks_in_time_order() {
        let points = (0..100_000).map(|i| {
            let value = if i == 77_777 {
                5.0
            } else {
                f64::from(i % 3) - 1.0
            };
            (f64::from(i) * 1e-4, value)
        });
        let thin = thinned(points, WINDOW, 100);
        assert!(thin.len() <= 200);
        assert!(thin.contains(&(77_777.0 * 1e-4, 5.0)));
        assert!(thin.is_sorted_by_key(|p| p.0));
    }

    #[test]
    fn thinning_drops_what_cannot_be_drawn() {
        let points = [
            (f64::NAN, 1.0),
            (1.0, f64::INFINITY),
            (2.0, 3.0),
            (11.0, 1.0),
        ];
        assert_eq!(thinned(points.into_iter(), WINDOW, 5), [(2.0, 3.0)]);
        assert_eq!(Interval::of([f64::NAN, f64::NEG_INFINITY, 1e300]), None);
    }

    #[test]
    fn brief_bands_survive() {
        let bands = [
            band(0, 0.0, 4.3),
            band(1, 4.3, 4.301),
            band(0, 4.301, 7.0),
            band(2, 7.0, 7.0),
            band(0, 20.0, 30.0),
        ];
        let expected = [
            band(0, 0.0, 4.0),
            band(1, 4.0, 5.0),
            band(0, 5.0, 7.0),
            band(2, 7.0, 8.0),
        ];
        assert_eq!(one_band_a_column(&bands, WINDOW, 10), expected);
    }

    #[test]
    fn a_path_driven_again_is_drawn_once() {
        let turn = |i: i32| {
            let (sin, cos) = (f64::from(i % 1000) * std::f64::consts::TAU / 1000.0).sin_cos();
            (cos, sin, i > 500_000)
        };
        let path: Vec<_> = (0..1_000_000).map(turn).collect();
        let stretches = trail(&path, 1.1, 300.0, 50_000);
        assert!(stretches.iter().map(|s| s.points.len()).sum::<usize>() < 2_100);
    }

    #[test]
    fn trembling_costs_little() {
        let tremble = |i: i32| (2e-3 * f64::from(i % 2), 1e-3 * f64::from(i % 3), false);
        let path: Vec<_> = (0..100_000).map(tremble).collect();
        let stretches = trail(&path, 1.0, 300.0, 1_000);
        assert!(stretches.iter().map(Stretch::cost).sum::<usize>() <= 1_000);
    }

    #[test]
    fn a_wild_path_stays_within_its_bytes() {
        let path: Vec<_> = (0..200_000_i32)
            .map(|i| {
                let x = f64::from(i);
                ((x * 12.9898).sin() * 1e6, (x * 78.233).sin(), i % 2 == 0)
            })
            .collect();
        let stretches = trail(&path, 1e6, 300.0, 20_000);
        assert!(stretches.iter().map(Stretch::cost).sum::<usize>() <= 20_000);
    }
}
