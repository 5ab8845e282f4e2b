#pragma once
// Short lists, one a sphere, in one piece of memory: a list that outgrows its room moves to the end, the
// others stay.
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

template <class T>
class Rows {
 public:
  /// Empties all; there will be `count` rows.
  void reset(int count) {
    rows_.assign(static_cast<std::size_t>(count), {});
    items_.clear();
    wasted_ = 0;
  }
  int rows() const { return static_cast<int>(rows_.size()); }
  int count(int i) const { return rows_[i].count; }
  std::span<T> row(int i) {
    return {items_.data() + rows_[i].begin, static_cast<std::size_t>(rows_[i].count)};
  }
  std::span<const T> row(int i) const {
    return {items_.data() + rows_[i].begin, static_cast<std::size_t>(rows_[i].count)};
  }
  const T* begin(int i) const { return items_.data() + rows_[i].begin; }
  T* begin(int i) { return items_.data() + rows_[i].begin; }

  /// Replaces row i. `items` must not lie in these rows.
  void assign(int i, std::span<const T> items) {
    reserve(i, static_cast<std::uint32_t>(items.size()), false);
    for (std::size_t k = 0; k < items.size(); ++k) items_[rows_[i].begin + k] = items[k];
    rows_[i].count = static_cast<std::int32_t>(items.size());
  }
  void insert(int i, int at, const T& item) {
    reserve(i, static_cast<std::uint32_t>(rows_[i].count + 1), true);
    T* const row = items_.data() + rows_[i].begin;
    for (int k = rows_[i].count; k > at; --k) row[k] = row[k - 1];
    row[at] = item;
    ++rows_[i].count;
  }
  void erase(int i, int at) {
    T* const row = items_.data() + rows_[i].begin;
    for (int k = at + 1; k < rows_[i].count; ++k) row[k - 1] = row[k];
    --rows_[i].count;
  }
  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void state(Stream& stream);
  /// Bytes held.
  std::size_t bytes() const { return items_.capacity() * sizeof(T) + rows_.capacity() * sizeof(Row); }

 private:
  struct Row {
    std::uint32_t begin = 0;
    std::int32_t count = 0;
    std::uint32_t capacity = 0;
  };
  void reserve(int i, std::uint32_t needed, bool keep) {
    Row& row = rows_[i];
    if (needed <= row.capacity) return;
    wasted_ += row.capacity;
    if (wasted_ > items_.size() / 2 + 1024) compact();
    const auto begin = static_cast<std::uint32_t>(items_.size());
    const std::uint32_t capacity = needed + needed / 4 + 2;
    items_.resize(begin + capacity);
    if (keep)
      for (int k = 0; k < row.count; ++k) items_[begin + k] = items_[row.begin + k];
    row.begin = begin;
    row.capacity = capacity;
  }
  // Closes the gaps that moved rows left.
  void compact() {
    std::vector<T> packed;
    packed.reserve(items_.size());
    for (Row& row : rows_) {
      const auto begin = static_cast<std::uint32_t>(packed.size());
      packed.insert(packed.end(), items_.begin() + row.begin, items_.begin() + row.begin + row.capacity);
      row.begin = begin;
    }
    items_.swap(packed);
    wasted_ = 0;
  }

  std::vector<Row> rows_;
  std::vector<T> items_;
  std::size_t wasted_ = 0;
};

}  // namespace scree
