#include "convex/composite/conjugate_atom.hpp"

namespace convex::inline composite {
namespace {

class ConjugateAtom final : public Atom {
 public:
  ConjugateAtom(std::shared_ptr<const Atom> f, Index n)
      : f_(std::move(f)), n_(n), conjugate_(f_->conjugate()) {}
  Index dimension() const override { return n_; }
  Facts facts() const override {
    const Facts of_f = f_->facts();
    Facts facts = conjugate_.node().facts();
    facts.separable = of_f.separable;
    return facts;
  }
  Call call() const override { return conjugate_.node().call(); }
  double value(const Vector& v) const override { return conjugate_.node().value(v); }
  Function conjugate() const override { return Function(f_); }
  std::optional<Vector> subgradient(const Vector& v) const override {
    return conjugate_.node().subgradient(v);
  }
  double recession(const Vector& d) const override { return f_->domain_support(d); }
  double domain_support(const Vector& v) const override { return f_->recession(v); }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    return z - f_->prox_diagonal(d.cwiseProduct(z), d.cwiseInverse()).cwiseQuotient(d);
  }
  Index decomposed_size(Index n) const override { return f_->decomposed_size(n); }
  bool prox_by_conjugate() const override { return true; }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    return f_->prox_jacobian(d.cwiseProduct(z), d.cwiseInverse()).of_conjugate(d);
  }

 private:
  std::shared_ptr<const Atom> f_;
  Index n_;
  Function conjugate_;
};

}  // namespace

std::shared_ptr<const Atom> conjugate_atom(std::shared_ptr<const Atom> f, Index n) {
  const Function conjugate = f->conjugate();
  if (auto atom = std::dynamic_pointer_cast<const Atom>(conjugate.shared())) return atom;
  return std::make_shared<const ConjugateAtom>(std::move(f), n);
}

}  // namespace convex::inline composite
