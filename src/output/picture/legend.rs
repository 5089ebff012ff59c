//! What stands under a picture, and pictures side by side.

use super::canvas::{Canvas, fitted, width};

const INK: [u8; 3] = [28, 34, 43];
const PALE: [u8; 3] = [93, 102, 115];
const RULE: [u8; 3] = [211, 216, 222];

/// Letters of a picture are so many times lower than it is wide, and no lower than so many pixels.
const LETTERS: (f32, f32) = (56.0, 12.0);

/// A line's height, of its letters'.
const LINE: f32 = 1.25;

/// Ticks of a bar, at most.
const TICKS: f64 = 8.0;

/// The bar of a heat map's colours.
#[derive(Clone, Debug)]
pub struct Bar {
    /// What the values are, with their unit.
    pub quantity: String,
    /// Value at either end.
    pub ends: [f64; 2],
    /// Whether places are of the values' logarithms.
    pub log: bool,
    /// The colour at a place from 0 to 1.
    pub colour: fn(f64) -> [u8; 3],
}

/// What a picture shows.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    /// What of.
    pub title: String,
    /// How many, how large.
    pub details: String,
    /// Of a heat map.
    pub bar: Option<Bar>,
}

impl Legend {
    /// The picture with this legend under it.
    #[must_use]
    pub fn under(&self, picture: &Canvas) -> Canvas {
        let [wide, high] = picture.size();
        let letters = (wide as f32 / LETTERS.0).max(LETTERS.1).round();
        let margin = (0.6 * letters).round();
        let lines = if self.bar.is_some() { 5.1 } else { 2.1 };
        let strip = (lines * LINE * letters + 2.0 * margin) as u32;
        let mut canvas = Canvas::new([wide, high + strip]);
        canvas.paste(picture, [0, 0]);
        canvas.fill([0, high], [wide, (letters / 16.0).ceil() as u32], RULE);
        let room = wide as f32 - 2.0 * margin;
        let mut top = high as f32 + margin;
        let size = 1.05 * letters;
        canvas.text([margin, top], size, INK, &fitted(size, &self.title, room));
        top += LINE * letters;
        canvas.text([margin, top], letters, PALE, &fitted(letters, &self.details, room));
        if let Some(bar) = &self.bar {
            top += 1.15 * LINE * letters;
            canvas.text([margin, top], letters, INK, &fitted(letters, &bar.quantity, room));
            bar.draw(&mut canvas, [margin, top + LINE * letters], room, letters);
        }
        canvas
    }
}

impl Bar {
    fn draw(&self, canvas: &mut Canvas, [left, top]: [f32; 2], room: f32, letters: f32) {
        let high = 0.7 * letters;
        let steps = room.max(1.0) as u32;
        for step in 0..steps {
            let place = (f64::from(step) + 0.5) / f64::from(steps);
            let colour = if self.ends[0] < self.ends[1] { place } else { 0.5 };
            canvas.fill([left as u32 + step, top as u32], [1, high as u32], (self.colour)(colour));
        }
        let mut free = 0.0;
        for (place, text) in ticks(self.ends, self.log) {
            let at = left + place as f32 * (room - 1.0);
            canvas.fill([at as u32, (top + high) as u32], [1, (0.25 * letters) as u32], PALE);
            let wide = width(letters, &text);
            // Where the bar ends, so do its numbers.
            let begin = (at - 0.5 * wide).clamp(left, (left + room - wide).max(left));
            if begin >= free {
                canvas.text([begin, top + high + 0.25 * letters], letters, PALE, &text);
                free = begin + wide + 0.5 * letters;
            }
        }
    }
}

/// The round values on a scale with these ends: where from 0 to 1, and as text.
#[must_use]
pub fn ticks([least, most]: [f64; 2], log: bool) -> Vec<(f64, String)> {
    if least >= most {
        return vec![(0.5, number(least))];
    }
    if log {
        let (from, to) = (least.log10(), most.log10());
        let decades = (from - 1e-9).ceil() as i32..=(to + 1e-9).floor() as i32;
        let tick =
            |decade: i32| ((f64::from(decade) - from) / (to - from), number(10_f64.powi(decade)));
        return decades.map(tick).collect();
    }
    let rough = (most - least) / TICKS;
    let decade = 10_f64.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    let step = steps.into_iter().find(|step| *step >= rough * (1.0 - 1e-9)).unwrap_or(steps[3]);
    let (first, last) = ((least / step - 1e-9).ceil() as i64, (most / step + 1e-9).floor() as i64);
    let tick = |k: i64| {
        let value = k as f64 * step;
        ((value - least) / (most - least), number(value))
    };
    (first..=last).map(tick).collect()
}

/// A value with no more figures than tell it apart.
fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "0" | "-0" if value != 0.0 => format!("{value:.0e}"),
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}

/// A count with a gap before every three figures.
#[must_use]
pub fn grouped(count: u64) -> String {
    let figures = count.to_string();
    let mut text = String::new();
    for (k, figure) in figures.chars().enumerate() {
        if k > 0 && (figures.len() - k).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(figure);
    }
    text
}

impl Canvas {
    /// Pictures in rows of so many columns, each column as wide as its widest.
    #[must_use]
    pub fn sheet(pictures: &[Self], columns: usize) -> Self {
        let columns = columns.clamp(1, pictures.len().max(1));
        let rows = pictures.len().div_ceil(columns);
        let most = |of: &dyn Fn(usize) -> bool, axis: usize| {
            let those = pictures.iter().enumerate().filter(|(k, _)| of(*k));
            those.map(|(_, picture)| picture.size()[axis]).max().unwrap_or(0)
        };
        let wide: Vec<u32> = (0..columns).map(|c| most(&|k| k % columns == c, 0)).collect();
        let high: Vec<u32> = (0..rows).map(|r| most(&|k| k / columns == r, 1)).collect();
        let mut sheet = Self::new([wide.iter().sum(), high.iter().sum()]);
        for (k, picture) in pictures.iter().enumerate() {
            let at = [wide[..k % columns].iter().sum(), high[..k / columns].iter().sum()];
            sheet.paste(picture, at);
        }
        sheet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(ends: [f64; 2], log: bool) -> Vec<String> {
        ticks(ends, log).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_at_their_places() {
        assert_eq!(texts([0.0, 0.5], false), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(texts([3.0, 8.0], false), ["3", "4", "5", "6", "7", "8"]);
        assert_eq!(texts([0.1, 1000.0], true), ["0.1", "1", "10", "100", "1000"]);
        assert_eq!(texts([8.0, 8.0], false), ["8"]);
        assert_eq!(texts([0.0, 2e-7], false)[0], "0");
        for (ends, log) in [([1.0, 64.0], false), ([0.01, 100.0], true), ([0.0, 0.02], false)] {
            let ticks = ticks(ends, log);
            assert!((3..=9).contains(&ticks.len()), "{ticks:?}");
            for (place, text) in ticks {
                let value: f64 = text.parse().unwrap();
                let real = if log {
                    (value / ends[0]).ln() / (ends[1] / ends[0]).ln()
                } else {
                    (value - ends[0]) / (ends[1] - ends[0])
                };
                assert!((place - real).abs() < 1e-6 && (-1e-9..1.0 + 1e-9).contains(&place));
            }
        }
    }

    #[test]
    fn counts_have_gaps() {
        assert_eq!(
            [7, 1234, 1_000_000].map(grouped).join(" "),
            "7 1\u{2009}234 1\u{2009}000\u{2009}000"
        );
    }

    #[test]
    fn a_legend_stands_under_its_picture_and_pictures_in_rows() {
        let picture = Canvas::of([300, 20], vec![9; 18_000]);
        let colour = |place: f64| [(200.0 * place) as u8, 0, 0];
        let bar = Bar { quantity: "x".to_owned(), ends: [0.0, 1.0], log: false, colour };
        let plain = Legend { title: "t".to_owned(), ..Legend::default() };
        let with_bar = Legend { bar: Some(bar), ..plain.clone() };
        let [plain, with_bar] = [plain, with_bar].map(|legend| legend.under(&picture));
        assert_eq!(plain.rgb()[..18_000], picture.rgb()[..]);
        assert!(with_bar.size()[1] > plain.size()[1]);
        // From left to right the bar has nearly all of its colours.
        let mut reds: Vec<u8> =
            with_bar.rgb().chunks(3).filter(|p| p[1] == 0).map(|p| p[0]).collect();
        reds.sort_unstable();
        reds.dedup();
        assert!(reds.len() > 150, "{}", reds.len());
        let sheet = Canvas::sheet(&[plain.clone(), with_bar.clone(), plain.clone()], 2);
        assert_eq!(sheet.size(), [600, with_bar.size()[1] + plain.size()[1]]);
    }
}
