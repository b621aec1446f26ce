#pragma once

namespace fiber::reference {

/// A vector of any kind of number.
template <class Number>
struct Vector {
  Number x;
  Number y;
  Number z;
};

template <class Number>
Vector<Number> operator+(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Number>
Vector<Number> operator-(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Number>
Vector<Number> operator*(const Number& factor, const Vector<Number>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace fiber::reference
