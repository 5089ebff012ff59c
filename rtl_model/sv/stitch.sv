// Stitch: a strip in, its triangles out, one a cycle.
//
// Moreton 2001, section 5.1: of the outer row's next segment and the inner row's, the one whose
// midpoint comes first on the edge gets the next triangle. `error` is the difference of the two
// midpoints over their common denominator: no division, and nothing is rounded. Rows of the
// interior grid have equally many segments and their diagonals turn at the patch's centre; they
// are walked as cells, two triangles each.
//
//     cells      inner  d---c---+---+---+      Bresenham   outer  o---o-----o-----o
//                       | / | / | \ | \ |                         | \ |  \ / \    |
//                outer  a---b---+---+---+                  inner  i-----i---------i
//
// Twin of rtl_model/src/stitch.rs, cycle by cycle: rtl_model/tests/lockstep compares the two. The
// cycle rules are those of rtl_model/src/time.rs with latency 1 and two strips in flight:
//
//                 +------+  walk is free  +------------+  room   +----------+
//     in_* ------>| held |--------------->| walk, error|-------->| FIFO     |
//          \      +------+   .----------->| left       |  out_*  | (outside)|
//           `----------------'            +------------+         +----------+
//
//   - A strip of T triangles occupies the input for T cycles, whether or not the output is stalled.
//   - It is accepted while a slot is free: of two strips, one is walked and one is held.
//   - Its first triangle can leave in the cycle after acceptance. Triangles leave in order, one a
//     cycle, where the FIFO behind had room at the start of the cycle (registered credit).
//
// Vertices are numbered within their patch: at most 16641 of them, so 15 bits.

`default_nettype none

module stitch (
    input  logic              clk,
    input  logic              reset,              // synchronous

    // The strip at the head of the FIFO before, stable until accepted.
    input  logic              in_valid,
    output logic              in_accept,          // it is taken in this cycle
    input  logic              in_cells,           // a row of the interior grid
    input  logic              in_lower,           // cells: the row lies below the patch's centre
    input  logic              in_mirrored,        // triangles swap their last two vertices
    input  logic              in_outer_back,      // the outer row runs against the numbering
    input  logic       [14:0] in_outer,           // first vertex of the outer row
    input  logic       [14:0] in_inner,           // first vertex of the inner row
    input  logic signed [7:0] in_inner_step,      // from one inner vertex to the next: -127..127
    input  logic        [6:0] in_outer_segments,  // 0..126; Bresenham: 0..64
    input  logic        [6:0] in_inner_segments,  // 0..126; Bresenham: 0..63; not both 0
    input  logic        [9:0] in_end,             // an outer row that begins so begins with 0

    // A triangle, counter-clockwise with u right and v up.
    input  logic              room,               // the FIFO behind had room at the cycle's start
    output logic              out_valid,          // the triangle leaves in this cycle
    output logic       [14:0] out_a,
    output logic       [14:0] out_b,
    output logic       [14:0] out_c
);

  typedef struct packed {
    logic              cells;
    logic              lower;
    logic              mirrored;
    logic              outer_back;
    logic       [14:0] outer;           // in the walk: the next vertex of the row
    logic       [14:0] inner;
    logic signed [7:0] inner_step;
    logic        [6:0] outer_segments;
    logic        [6:0] inner_segments;
    logic        [9:0] edges_end;
  } strip_t;  // 66 bits

  strip_t            arriving;
  strip_t            held;        // waits for the walk to end
  logic              held_valid;  // only while something is walked
  strip_t            walk;
  logic signed [7:0] error;       // Bresenham: -128..126
  logic        [7:0] left;        // triangles of the walk still to leave, 0..252; 0: idle
  logic        [7:0] interval;    // cycles until the next strip may be accepted, 0..251

  assign arriving = {
    in_cells, in_lower, in_mirrored, in_outer_back, in_outer, in_inner, in_inner_step,
    in_outer_segments, in_inner_segments, in_end
  };

  // ---- Handshakes -----------------------------------------------------------------------------

  logic walk_free;  // at the end of this cycle
  strip_t next;     // what is walked then

  assign in_accept = in_valid && interval == 8'd0 && !held_valid;
  assign out_valid = left != 8'd0 && room;
  assign walk_free = left == 8'd0 || (left == 8'd1 && out_valid);
  assign next      = held_valid ? held : arriving;

  // Each triangle stands on a segment of one of the rows: 1..252 of them.
  logic [7:0] arriving_count;
  logic [7:0] next_count;
  assign arriving_count = {1'b0, in_outer_segments} + {1'b0, in_inner_segments};
  assign next_count     = {1'b0, next.outer_segments} + {1'b0, next.inner_segments};

  // ---- This cycle's triangle ------------------------------------------------------------------

  logic [14:0] outer_this;        // vertex 0 where the row begins with the end; no walk gets there
  logic [14:0] outer_next;
  logic [14:0] inner_next;
  logic        second;            // cells: the second triangle of its pair; their number is even
  logic        first_half;        // cells: the cell lies before the middle of the row
  logic        rising;            // cells: the diagonal starts at the outer vertex
  logic        on_inner;          // Bresenham: the triangle stands on an inner segment
  logic [14:0] a, b, c;

  assign outer_next = walk.outer_back ? walk.outer - 15'd1 : walk.outer + 15'd1;
  assign inner_next = walk.inner + {{7{walk.inner_step[7]}}, walk.inner_step};
  assign outer_this = walk.outer == {5'd0, walk.edges_end} ? 15'd0 : walk.outer;

  // Of n cells, k are done: before the middle where 2k < n, which is where 2(n - k) > n; and
  // 2(n - k) is `left` rounded up to an even number, 8 bits.
  assign second     = left[0];
  assign first_half = left + {7'd0, second} > {1'b0, walk.outer_segments};
  assign rising     = first_half == walk.lower;
  assign on_inner   = !error[7];

  always_comb begin
    if (walk.cells) begin
      a = second && !rising ? outer_next : outer_this;
      b = second ? inner_next : outer_next;
      c = !second && rising ? inner_next : walk.inner;
    end else begin
      a = on_inner ? walk.inner : outer_this;
      b = on_inner ? outer_this : outer_next;
      c = on_inner ? inner_next : walk.inner;
    end
  end

  assign out_a = a;
  assign out_b = walk.mirrored ? c : b;
  assign out_c = walk.mirrored ? b : c;

  // ---- State ----------------------------------------------------------------------------------

  always_ff @(posedge clk) begin
    if (reset) begin
      held_valid <= 1'b0;
      left       <= 8'd0;
      interval   <= 8'd0;
    end else begin
      if (in_accept) interval <= arriving_count - 8'd1;
      else if (interval != 8'd0) interval <= interval - 8'd1;

      if (walk_free) held_valid <= 1'b0;
      else if (in_accept) held_valid <= 1'b1;
      if (in_accept) held <= arriving;

      if (walk_free) begin
        walk  <= next;
        error <= {1'b0, next.inner_segments} - {1'b0, next.outer_segments};
        left  <= held_valid || in_accept ? next_count : 8'd0;
      end else if (out_valid) begin
        left <= left - 8'd1;
        if (walk.cells ? second : !on_inner) walk.outer <= outer_next;
        if (walk.cells ? second : on_inner) walk.inner <= inner_next;
        // At most 128 in steps of 8 bits, modulo 256: the result is in range, so it is exact.
        error <= on_inner ? error - {walk.outer_segments, 1'b0}
                          : error + {walk.inner_segments, 1'b0};
      end
    end
  end

endmodule

`default_nettype wire
