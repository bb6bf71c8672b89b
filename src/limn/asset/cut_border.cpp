#include "limn/asset/cut_border.h"

namespace limn::asset {

std::uint32_t CutBorder::add(VertexId from, VertexId opposite) {
  const auto edge = static_cast<std::uint32_t>(edges_.size());
  edges_.push_back({from, opposite, edge, edge, true, true});
  waiting_.push_back(edge);
  place_[from] = edge;
  return edge;
}

void CutBorder::link(std::uint32_t first, std::uint32_t second) {
  edges_[first].next = second;
  edges_[second].previous = first;
}

/// The edge runs elsewhere now, before a new face.
void CutBorder::replace(std::uint32_t edge, VertexId opposite) {
  edges_[edge].opposite = opposite;
  if (!edges_[edge].open) waiting_.push_back(edge);
  edges_[edge].open = true;
}

bool CutBorder::has_gate() {
  const auto good = [this](std::uint32_t edge) { return edges_[edge].open && edges_[edge].there; };
  if (gate_ != kNone && good(gate_)) return true;
  while (!waiting_.empty()) {
    gate_ = waiting_.back();
    waiting_.pop_back();
    if (good(gate_)) return true;
  }
  gate_ = kNone;
  return false;
}

void CutBorder::attach(VertexId third) {
  const VertexId first = from(), second = to();
  for (const VertexId v : {first, second, third})
    ++faces_[v];
  const std::uint32_t previous = edges_[gate_].previous, next = edges_[gate_].next;
  if (third == edges_[previous].from && previous != gate_) {
    take_out(gate_);
    link(previous, next);
    gate_ = previous;
    replace(gate_, first);
  } else if (third == after() && next != gate_) {
    link(gate_, edges_[next].next);
    take_out(next);
    replace(gate_, second);
  } else {
    insert(third);
  }
  drop_pair();
}

/// The border runs through the third vertex: between its own edges there where it is on the border already, which
/// splits a loop or joins two.
void CutBorder::insert(VertexId third) {
  const VertexId first = from(), second = to();
  const std::uint32_t there = place_[third];
  const std::uint32_t next = edges_[gate_].next;
  const bool known = there != kNone && edges_[there].there && edges_[there].from == third;
  const std::uint32_t rest = add(third, first);
  edges_[gate_].opposite = second;
  if (known) {
    const std::uint32_t before = edges_[there].previous;
    link(gate_, there);
    link(before, rest);
  } else {
    link(gate_, rest);
  }
  link(rest, next);
}

/// Two edges that run there and back are one edge with both its faces.
void CutBorder::drop_pair() {
  const std::uint32_t next = edges_[gate_].next;
  if (next == gate_ || edges_[next].next != gate_) return;
  take_out(gate_);
  take_out(next);
}

void CutBorder::begin(const Triangle& face) {
  for (const VertexId v : face)
    ++faces_[v];
  const std::uint32_t back = add(face[1], face[2]);
  const std::uint32_t to_last = add(face[0], face[1]);
  const std::uint32_t last = add(face[2], face[0]);
  link(back, to_last);
  link(to_last, last);
  link(last, back);
  gate_ = back;
}

}  // namespace limn::asset
