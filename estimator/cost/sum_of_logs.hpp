// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace cremed {

/// Sum of the logarithms of positive numbers, each between 1e-100 and 1e100. Takes one logarithm of
/// a product of many.
class SumOfLogs {
 public:
  void add(double number) {
    product_ *= number;
    if (!(product_ > 1e-200 && product_ < 1e200)) {
      sum_ += std::log(product_);
      product_ = 1.0;
    }
  }
  [[nodiscard]] double value() const { return sum_ + std::log(product_); }

 private:
  double sum_ = 0.0;
  double product_ = 1.0;
};

}  // namespace cremed
