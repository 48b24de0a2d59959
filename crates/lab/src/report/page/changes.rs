//! Differences in words.

use maud::{Markup, html};

use crate::report::number::significant as number;
use crate::report::tables::comparison::in_percent;
use crate::study::compare::{Changes, FigureComparison, Outlook};

/// The changes since an older report.
pub(super) fn changes_section(changes: &Changes) -> Markup {
    let Changes { older, policies, unmatched } = changes;
    html! {
        section {
            h2 { "Changes since " (older) }
            @for (policy, figures) in policies {
                h3 { (policy) }
                (sentences(figures.iter()))
            }
            @if policies.is_empty() { p { "The older report has none of these runs." } }
            @if *unmatched > 0 { p { (unmatched) @if *unmatched == 1 { " run is" } @else { " runs are" } " not in the older report." } }
        }
    }
}

/// The figures that differ as sentences: the significant differences first, then the others.
pub(super) fn sentences<'f>(figures: impl Iterator<Item = &'f FigureComparison>) -> Markup {
    let figures: Vec<_> = figures.collect();
    let of = |outlook: Outlook| figures.iter().filter(move |figure| figure.outlook == outlook);
    let same = of(Outlook::Same).count();
    let mut shown = of(Outlook::Worse).chain(of(Outlook::Better)).chain(of(Outlook::Open)).peekable();
    html! {
        @if shown.peek().is_some() {
            ul.changes { @for figure in shown { li { (sentence(figure)) } } }
        }
        @if same > 0 { p { (same) @if same == 1 { " figure is" } @else { " figures are" } " the same in all pairs of runs." } }
    }
}

fn sentence(figure: &FigureComparison) -> Markup {
    let FigureComparison { figure: name, pairs, first, mean, difference, wins, losses, outlook, .. } =
        &*in_percent(figure);
    let (verb, size) = if difference.mean < 0.0 { ("fell", -difference.mean) } else { ("rose", difference.mean) };
    let interval = difference.interval.map(|[low, high]| {
        let sign = if difference.mean < 0.0 { -1.0 } else { 1.0 };
        let (low, high) = if sign < 0.0 { (-high, -low) } else { (low, high) };
        format!("95 % interval {} to {}", number(low), number(high))
    });
    let judgement = match outlook {
        Outlook::Better => html! { b.better { "better" } },
        Outlook::Worse => html! { b.worse { "worse" } },
        Outlook::Same => html! { "the same" },
        Outlook::Open => html! { "not distinguishable" },
    };
    html! {
        code { (name) } " " (verb) " from " (number(*first)) " to " (number(*mean)) ", by " (number(size))
        " (" @if let Some(interval) = &interval { (interval) ", " } (pairs) " pairs, " (wins) " better, " (losses) " worse): " (judgement) "."
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::study::compare::figures;

    #[test]
    fn one_figure_is_in_the_singular() {
        let figure = |name: &str| figures().into_iter().find(|figure| figure.name == name).unwrap();
        let same = |name: &str| FigureComparison::new(&figure(name), "b.fsm", vec![(1.0, 1.0)]).unwrap();
        let (one, two) = ([same("coverage")], [same("coverage"), same("path_m")]);
        assert!(sentences(one.iter()).into_string().contains("1 figure is the same"));
        assert!(sentences(two.iter()).into_string().contains("2 figures are the same"));
    }

    #[test]
    fn a_change_is_a_sentence_with_its_interval_in_the_direction_of_the_verb() {
        let coverage = figures().into_iter().find(|figure| figure.name == "coverage").unwrap();
        let pairs = vec![(0.90, 0.92), (0.91, 0.94), (0.92, 0.93)];
        let rose = FigureComparison::new(&coverage, "b.fsm", pairs.clone()).unwrap();
        let fell = pairs.into_iter().map(|(first, other)| (other, first)).collect();
        let fell = FigureComparison::new(&coverage, "b.fsm", fell).unwrap();
        let text = |figure| sentence(figure).into_string();
        assert_eq!(
            text(&rose),
            "<code>coverage</code> rose from 0.910 to 0.930, by 0.0200 (95 % interval -0.00484 to 0.0448, 3 pairs, 3 better, 0 worse): \
             not distinguishable."
        );
        assert!(
            text(&fell).contains("fell from 0.930 to 0.910, by 0.0200 (95 % interval -0.00484 to 0.0448"),
            "{}",
            text(&fell)
        );
    }
}
