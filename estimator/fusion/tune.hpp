#pragma once
#include <cstdlib>
#include <cstring>
#include <string>
namespace cremed {
inline double tune(const char* name, double value) {
  const char* t = std::getenv("TUNE");
  if (!t) return value;
  std::string s = std::string(",") + t;
  auto p = s.find(std::string(",") + name + "=");
  return p == std::string::npos ? value : std::atof(s.c_str() + p + 2 + std::strlen(name));
}
}  // namespace cremed
