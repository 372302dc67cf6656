//! CalculiX: springs and dashpots on relative displacements, for which equations make auxiliary nodes.
//!
//! A spring of CalculiX connects a displacement with another or with the ground, and its only dashpot acts along the line between
//! two nodes. So each relative motion r_i becomes the displacement along x of a node of its own, held otherwise, by an equation.
//! ½ K_ij r_i r_j + ½ K_ji r_j r_i is a spring −K_ij between the nodes of r_i and r_j, and K_ij more of each on its own:
//! −½ K_ij (r_i − r_j)² + ½ K_ij (r_i² + r_j²) = K_ij r_i r_j.

use std::fmt::Write as _;

use crate::head::Head;
use crate::linear::Linear;
use crate::{Converted, Options};

pub(crate) fn deck(linear: &Linear, options: &Options, mut head: Head) -> Converted {
    let [a, b] = options.nodes;
    let [turn_a, turn_b] = options.rotation_nodes;
    let first = options.first_number;
    head.note(format!(
        "nodes {a} (side a) and {b} (side b) coincide; include this file before the first *STEP"
    ));
    if linear.axes.iter().any(|axis| *axis > 2) {
        head.note(format!(
            "the displacements 1, 2, 3 of nodes {turn_a} (side a) and {turn_b} (side b) are the rotations about x, y, z, as those of the \
             ROT NODE of a *RIGID BODY are"
        ));
    }
    if linear.is_coupled() {
        head.note("the joint couples its motions: springs and dashpots between the auxiliary nodes carry that, some of them negative");
    }
    if linear
        .axes
        .iter()
        .any(|&axis| linear.damping[axis][axis] != 0.0)
    {
        head.note("dashpots take part in *STEADY STATE DYNAMICS and *DYNAMIC, not in *FREQUENCY");
    }
    let mut deck = Deck::new(options, first);
    for &axis in &linear.axes {
        deck.relative(axis, if axis < 3 { [a, b] } else { [turn_a, turn_b] });
    }
    for &axis in &linear.axes {
        let of = |matrix: &[[f64; 6]; 6]| matrix[axis].iter().sum::<f64>();
        deck.on_its_own(axis, of(&linear.stiffness), of(&linear.damping));
    }
    for (i, j, stiffness, damping) in linear.pairs() {
        deck.between(i, j, -stiffness, -damping);
    }
    Converted {
        text: head.comments("** ") + &deck.text,
        notes: head.notes,
    }
}

struct Deck {
    text: String,
    set: String,
    /// Node of the first relative motion; that which it is to be held against is six further on.
    first_node: u32,
    next_element: u32,
}

impl Deck {
    fn new(options: &Options, first: u32) -> Self {
        Self {
            text: String::new(),
            set: options.identifier.to_uppercase(),
            first_node: first,
            next_element: first,
        }
    }

    fn node(&self, axis: usize) -> u32 {
        self.first_node + u32::try_from(axis).unwrap_or(0)
    }

    fn ground(&self, axis: usize) -> u32 {
        self.node(axis) + 6
    }

    /// Node with r = x_a − x_b as its displacement along x, and a ground beside it.
    fn relative(&mut self, axis: usize, [a, b]: [u32; 2]) {
        let (node, ground, dof) = (self.node(axis), self.ground(axis), axis % 3 + 1);
        let place = axis as f64;
        // writing to a String cannot fail
        let _ = write!(
            self.text,
            "*NODE\n{node}, {place}, 0., 0.\n{ground}, {}, 0., 0.\n*BOUNDARY\n{node}, 2, 3\n{ground}, 1, 3\n\
             *EQUATION\n3\n{node}, 1, 1., {a}, {dof}, -1., {b}, {dof}, 1.\n",
            place + 0.5
        );
    }

    fn on_its_own(&mut self, axis: usize, stiffness: f64, damping: f64) {
        let node = self.node(axis);
        self.element("SPRING1", &[node], "SPRING", "1", stiffness);
        let ground = self.ground(axis);
        self.element("DASHPOTA", &[node, ground], "DASHPOT", "", damping);
    }

    fn between(&mut self, i: usize, j: usize, stiffness: f64, damping: f64) {
        let nodes = [self.node(i), self.node(j)];
        self.element("SPRING2", &nodes, "SPRING", "1, 1", stiffness);
        self.element("DASHPOTA", &nodes, "DASHPOT", "", damping);
    }

    fn element(&mut self, kind: &str, nodes: &[u32], keyword: &str, dofs: &str, value: f64) {
        if value == 0.0 {
            return;
        }
        let number = self.next_element;
        self.next_element += 1;
        let set = format!("{}_{number}", self.set);
        let nodes: Vec<String> = nodes.iter().map(u32::to_string).collect();
        let _ = write!(
            self.text,
            "*ELEMENT, TYPE={kind}, ELSET={set}\n{number}, {}\n*{keyword}, ELSET={set}\n{dofs}\n{value:.12E}\n",
            nodes.join(", ")
        );
    }
}
