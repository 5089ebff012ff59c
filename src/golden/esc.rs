//! Esc: which candidates of a coarse triangle's edges are inserted in, strips and triangles out.
//!
//! Concheiro, Amor, Boo, Padron 2014, section 3, to the letter: the lists of the uniform pattern
//! (equation 10) are written down, and each of the paper's rules rewrites them. Triangles are three
//! in a row of a list, turned counter-clockwise by their area. The hardware has no lists, no rule
//! beyond the choice of a stand-in, and a winding of its own.
//!
//! Where the paper is silent: of two inserted vertices of the bottom edge that are equally near,
//! the right one; several empty rows are as one; above the first row there is the apex.

pub mod resolution;
pub mod surface;

use std::cmp::Reverse;

/// A coarse triangle: which candidates are inserted, by vertex number (1 is the apex).
#[derive(Clone, Debug)]
pub struct Coarse {
    /// Numbers of the vertices row by row, each from the left.
    rows: Vec<Vec<usize>>,
    /// The vertices of the left, right and bottom edge, with corners, whether they are inserted or
    /// not; left and right from the apex.
    edges: [Vec<usize>; 3],
    /// Inserted, by number; the first is no vertex's.
    inserted: Vec<bool>,
}

impl Coarse {
    /// From the candidates of the left, right and bottom edge, as many on each, corners left out.
    ///
    /// # Panics
    /// Where edges have different numbers of candidates.
    #[must_use]
    pub fn new(candidates: &[Vec<bool>; 3]) -> Self {
        let level = candidates[0].len();
        assert!(candidates.iter().all(|edge| edge.len() == level), "one level");
        let mut numbers = 1..;
        let rows: Vec<Vec<usize>> =
            (1..=level + 2).map(|count| numbers.by_ref().take(count).collect()).collect();
        let bottom = rows[level + 1].clone();
        let left: Vec<usize> = rows.iter().map(|row| row[0]).collect();
        let right: Vec<usize> = rows.iter().map(|row| row[row.len() - 1]).collect();
        let edges = [left, right, bottom];
        let mut inserted = vec![false; edges[2][level + 1] + 1];
        for (edge, candidates) in edges.iter().zip(candidates) {
            inserted[edge[0]] = true;
            inserted[edge[level + 1]] = true;
            for (&vertex, _) in edge[1..].iter().zip(candidates).filter(|(_, there)| **there) {
                inserted[vertex] = true;
            }
        }
        for row in &rows[1..=level] {
            let [first, .., last] = row[..] else { unreachable!("row 1 has two vertices") };
            if inserted[first] || inserted[last] {
                row[1..row.len() - 1].iter().for_each(|&vertex| inserted[vertex] = true);
            }
        }
        Self { rows, edges, inserted }
    }

    /// The numbers of the inserted vertices, in order.
    #[must_use]
    pub fn vertices(&self) -> Vec<usize> {
        (1..self.inserted.len()).filter(|&vertex| self.inserted[vertex]).collect()
    }

    /// How many of them are on the edges.
    #[must_use]
    pub fn boundary(&self) -> usize {
        let on_edge = |vertex: &usize| self.edges.iter().any(|edge| edge.contains(vertex));
        self.vertices().iter().filter(|vertex| on_edge(vertex)).count()
    }

    /// The strips' lists after all rules, from the apex down; those of empty rows are eliminated.
    #[must_use]
    pub fn lists(&self) -> Vec<Vec<usize>> {
        let kept = (1..self.rows.len()).filter(|&row| !self.is_empty(row));
        kept.map(|row| self.alternating(without_replicas(self.substituted(row)))).collect()
    }

    /// Triangles in the order of the lists: counter-clockwise with the apex at the top, each from
    /// its least number.
    ///
    /// # Panics
    /// Where three different vertices of a list are in a line: the rules make none such.
    #[must_use]
    pub fn triangles(&self) -> Vec<[usize; 3]> {
        let lists = self.lists();
        let threes = lists.iter().flat_map(|list| list.windows(3));
        let triangles = threes.map(|three| [three[0], three[1], three[2]]);
        triangles.filter(|[a, b, c]| a != b && b != c && c != a).map(|t| self.turned(t)).collect()
    }

    /// The vertices of a row between apex and bottom are missing as a whole, or not at all but for
    /// its ends.
    fn is_empty(&self, row: usize) -> bool {
        let row = &self.rows[row];
        row.iter().all(|&vertex| !self.inserted[vertex])
    }

    /// The uniform pattern's list of the strip above `row`, every missing vertex substituted.
    fn substituted(&self, row: usize) -> Vec<usize> {
        let lower = self.rows[row].iter().map(|&vertex| self.stand_in(vertex));
        let mut upper = if self.is_empty(row - 1) {
            self.replicated(row)
        } else {
            self.rows[row - 1].iter().map(|&vertex| self.stand_in(vertex)).collect()
        }
        .into_iter();
        // lower, upper, lower, .. lower
        lower.flat_map(|vertex| [Some(vertex), upper.next()]).flatten().collect()
    }

    /// Rules 1 and 2, missing vertices: the nearest that is inserted on the same edge, of two the
    /// one in the lower row.
    fn stand_in(&self, vertex: usize) -> usize {
        if self.inserted[vertex] {
            return vertex;
        }
        let place = |edge: &Vec<usize>| edge.iter().position(|&other| other == vertex);
        let (edge, at) = self
            .edges
            .iter()
            .find_map(|edge| place(edge).map(|at| (edge, at)))
            .expect("inner vertices of a row that is not empty are inserted");
        let others = (0..edge.len()).filter(|&other| self.inserted[edge[other]]);
        let nearest = others.min_by_key(|&other| (other.abs_diff(at), Reverse(other)));
        edge[nearest.expect("corners are inserted")]
    }

    /// The rules for empty rows: as many vacancies as `row` is long less one, covered with the
    /// vertices of the closest row above that is not empty. Its own are replicated uniformly: where
    /// there are m of them for v vacancies, vertex k covers those from k v / m to (k + 1) v / m. A
    /// virtual vertex is employed once.
    fn replicated(&self, row: usize) -> Vec<usize> {
        let above = (0..row).rev().find(|&above| !self.is_empty(above)).expect("the apex is there");
        let above = &self.rows[above];
        let own: Vec<usize> = above.iter().copied().filter(|&v| self.inserted[v]).collect();
        let vacancies = row - (above.len() - own.len());
        let mut covered = Vec::new();
        for &vertex in above {
            let Some(k) = own.iter().position(|&other| other == vertex) else {
                covered.push(self.stand_in(vertex));
                continue;
            };
            let [from, to] = [k, k + 1].map(|k| (k * vacancies).div_ceil(own.len()));
            covered.extend((from..to).map(|_| vertex));
        }
        covered
    }

    /// Rule 4: of three in a row, the last two of one row of vertices, the first is listed again
    /// before the last. A virtual vertex is of the row in which it lies.
    fn alternating(&self, list: Vec<usize>) -> Vec<usize> {
        let row = |vertex: usize| self.at(vertex)[0];
        let mut out: Vec<usize> = Vec::new();
        for vertex in list {
            if let [.., i, j] = out[..]
                && row(j) == row(vertex)
            {
                out.push(i);
            }
            out.push(vertex);
        }
        out
    }

    /// Row and place in the row.
    fn at(&self, vertex: usize) -> [i64; 2] {
        let row = self.rows.iter().position(|row| row.contains(&vertex)).expect("a vertex");
        [row as i64, (vertex - self.rows[row][0]) as i64]
    }

    fn turned(&self, [a, b, c]: [usize; 3]) -> [usize; 3] {
        // x is the place; y, up, is less the row. Sheared, which keeps the sign of an area.
        let [p, q, r] = [a, b, c].map(|vertex| self.at(vertex));
        let twice = (q[1] - p[1]) * (p[0] - r[0]) - (p[0] - q[0]) * (r[1] - p[1]);
        assert!(twice != 0, "{a} {b} {c} are in a line");
        let mut triangle = if twice > 0 { [a, b, c] } else { [a, c, b] };
        let least = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
        triangle.rotate_left(least);
        triangle
    }
}

/// Rule 3: v v becomes v.
fn without_replicas(mut list: Vec<usize>) -> Vec<usize> {
    list.dedup();
    list
}
