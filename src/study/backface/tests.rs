//! The study, small: what it must find, and that nothing of it hangs on threads.

use super::*;
use crate::trace::scene::newell::Newell;

const SMALL: Options = Options { views: 6, random: 400 };

fn find(rows: &[Row], source: Source, place: Place, method: Method) -> &Row {
    let found = rows.iter().find(|r| (r.source, r.place, r.method) == (source, place, method));
    found.expect("every source has every method in both places")
}

#[test]
fn each_test_is_found_to_be_what_it_is() {
    let rows = run(SMALL).unwrap();
    assert_eq!(rows.len(), Source::ALL.len() * METHODS.len() * 2);
    for row in &rows {
        let Row { source, method, score, .. } = row;
        let Score { tested, away, away_culled, culled, .. } = *score;
        let place = row.place;
        assert_eq!(culled, away_culled + score.false_quantised);
        assert!(away_culled <= away && away <= tested && tested > 0);
        assert!(score.facets <= tested * u64::from(method.facets()) && score.facets >= tested);
        let conservative = matches!(method, Method::NormalCone | Method::TangentPlane);
        assert!(!conservative || score.false_quantised == 0, "{source:?} {place:?} {method:?}");
        let literal = *method == Method::HullLiteral;
        assert!(!literal || (culled == 0) == (place == Place::Outside), "{source:?} {place:?}");
    }
    // The places are what they are called: within, the literal reading drops all but flat patches.
    let random = |place, method| find(&rows, Source::Random, place, method).score;
    let literal = random(Place::Within, Method::HullLiteral);
    assert!(
        literal.culled * 10 > literal.tested * 7 && literal.false_quantised * 2 > literal.culled
    );
    let (cone, plane) =
        (random(Place::Outside, Method::NormalCone), random(Place::Outside, Method::TangentPlane));
    assert!(cone.away_culled < plane.away_culled && cone.away_culled * 3 > plane.away_culled);
    assert_eq!(cone.tested, SMALL.random as u64);
    let teapot = Source::Model(Newell::Teapot);
    assert_eq!(find(&rows, teapot, Place::Outside, Method::NetFacets).score.tested, 6 * 32);
    assert_eq!(find(&rows, teapot, Place::Within, Method::NetFacets).score.tested, 32);
}

#[test]
fn operations_are_those_of_the_facets_looked_at() {
    let rows = run(Options { views: 2, random: 50 }).unwrap();
    let config = Config::default();
    for Row { method, score, ops, ops_early, .. } in &rows {
        let all = arithmetic::backface::test(*method, method.facets(), &config);
        assert_eq!(*ops, Ops::default().with(score.tested, all));
        assert!(ops_early.mul <= ops.mul && ops_early.add_bits <= ops.add_bits);
        let saved = score.facets < score.tested * u64::from(method.facets());
        assert_eq!(ops_early.mul < ops.mul, saved, "{method:?}");
        assert!(ops_early.compare >= score.facets, "{method:?}: a sign is a comparison");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_rows() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(Options { views: 5, random: 60 }).unwrap())
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one, three);
    let csv = csv(&one);
    assert_eq!(csv.lines().count(), 1 + one.len());
    let columns = csv.lines().map(|line| line.split(',').count());
    assert!(columns.clone().all(|n| n == CSV_HEADER.len()));
    assert!(csv.starts_with("patches,viewer,method,tested,") && !csv.contains('.'));
}
