//! serde's traits, by definitions that the derive holds against the types: a field that is missing here does not compile.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Error, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Beam, Polygon, Scalar, Vector};

/// A number that a format without infinities can hold.
struct Number<T>(T);

const INFINITY: &str = "Infinity";
const NEG_INFINITY: &str = "-Infinity";
const NAN: &str = "NaN";

impl<T: Scalar + Serialize> Serialize for Number<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(value) = *self;
        if value.is_finite() || !serializer.is_human_readable() {
            value.serialize(serializer)
        } else if value > T::ZERO {
            serializer.serialize_str(INFINITY)
        } else if value < T::ZERO {
            serializer.serialize_str(NEG_INFINITY)
        } else {
            serializer.serialize_str(NAN)
        }
    }
}

impl<'de, T: Scalar + Deserialize<'de>> Deserialize<'de> for Number<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(NumberVisitor(PhantomData)).map(Self)
        } else {
            T::deserialize(deserializer).map(Self)
        }
    }
}

struct NumberVisitor<T>(PhantomData<T>);

impl<T: Scalar> Visitor<'_> for NumberVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let largest: f64 = T::MAX.into();
        write!(f, "a number up to ±{largest:e}, {INFINITY:?}, {NEG_INFINITY:?} or {NAN:?}")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        let number = T::ONE.lit(value);
        if value.is_finite() && !number.is_finite() {
            return Err(E::invalid_value(Unexpected::Float(value), &self));
        }
        Ok(number)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<T, E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<T, E> {
        match value {
            INFINITY => Ok(T::INFINITY),
            NEG_INFINITY => Ok(-T::INFINITY),
            NAN => Ok(T::NAN),
            _ => Err(E::invalid_value(Unexpected::Str(value), &self)),
        }
    }
}

/// A vector of such numbers.
struct Three<V>(V);

impl<V: Vector<Scalar: Serialize>> Serialize for Three<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(v) = *self;
        [v.x(), v.y(), v.z()].map(Number).serialize(serializer)
    }
}

impl<'de, V: Vector<Scalar: Deserialize<'de>>> Deserialize<'de> for Three<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let [Number(x), Number(y), Number(z)] = Deserialize::deserialize(deserializer)?;
        Ok(Self(V::new(x, y, z)))
    }
}

/// How the fields of the definitions below are written and read.
mod number {
    use super::{Deserialize, Deserializer, Number, Scalar, Serialize, Serializer};

    pub(super) fn serialize<T: Scalar + Serialize, S: Serializer>(
        value: &T,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        Number(*value).serialize(serializer)
    }

    pub(super) fn deserialize<'de, T: Scalar + Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        Number::deserialize(deserializer).map(|Number(value)| value)
    }
}

mod vector {
    use super::{Deserialize, Deserializer, Serialize, Serializer, Three, Vector};

    pub(super) fn serialize<V: Vector<Scalar: Serialize>, S: Serializer>(
        value: &V,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        Three(*value).serialize(serializer)
    }

    pub(super) fn deserialize<'de, V: Vector<Scalar: Deserialize<'de>>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<V, D::Error> {
        Three::deserialize(deserializer).map(|Three(value)| value)
    }
}

mod vectors {
    use super::{Deserialize, Deserializer, Serialize, Serializer, Three, Vector};

    pub(super) fn serialize<V: Vector<Scalar: Serialize>, S: Serializer>(
        values: &[V; 4],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        values.map(Three).serialize(serializer)
    }

    pub(super) fn deserialize<'de, V: Vector<Scalar: Deserialize<'de>>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[V; 4], D::Error> {
        <[Three<V>; 4]>::deserialize(deserializer).map(|values| values.map(|Three(value)| value))
    }
}

/// Both traits of a type, by a definition in which its fields stand again.
macro_rules! stored {
    ($name:ident<V> = $remote:literal, $($definition:tt)+) => {
        stored!(@ $name<V: Vector>, V::Scalar, $remote, "V: Vector, V::Scalar: Serialize",
            "V: Vector, V::Scalar: Deserialize<'de>", $($definition)+);
    };
    ($name:ident<T> = $remote:literal, $($definition:tt)+) => {
        stored!(@ $name<T: Scalar>, T, $remote, "T: Scalar + Serialize", "T: Scalar + Deserialize<'de>", $($definition)+);
    };
    (@ $name:ident<$p:ident: $bound:ident>, $number:ty, $remote:literal, $writes:literal, $reads:literal, $($definition:tt)+) => {
        const _: () = {
            #[derive(Serialize, Deserialize)]
            #[serde(remote = $remote, bound(serialize = $writes, deserialize = $reads))]
            $($definition)+

            impl<$p: $bound> Serialize for named::$name<$p>
            where
                $number: Serialize,
            {
                fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    $name::serialize(self, serializer)
                }
            }

            impl<'de, $p: $bound> Deserialize<'de> for named::$name<$p>
            where
                $number: Deserialize<'de>,
            {
                fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    $name::deserialize(deserializer)
                }
            }
        };
    };
}

/// The types as they are, beside their definitions.
mod named {
    pub(super) use crate::overlap::ConeHit;
    pub(super) use crate::ray::aabb::AabbHit;
    pub(super) use crate::ray::plane::PlaneHit;
    pub(super) use crate::ray::polygon::PolygonHit;
    pub(super) use crate::ray::sphere::SphereHit;
    pub(super) use crate::ray::triangle::TriangleHit;
    pub(super) use crate::{Aabb, Cone, Plane, Pyramid, Ray, Sphere, Triangle};
}

stored!(Ray<V> = "named::Ray", struct Ray<V: Vector> {
    #[serde(with = "vector")]
    origin: V,
    #[serde(with = "vector")]
    direction: V,
    #[serde(with = "number")]
    t_min: V::Scalar,
    #[serde(with = "number")]
    t_max: V::Scalar,
});

stored!(Plane<V> = "named::Plane", struct Plane<V: Vector> {
    #[serde(with = "vector")]
    normal: V,
    #[serde(with = "number")]
    offset: V::Scalar,
});

stored!(Sphere<V> = "named::Sphere", struct Sphere<V: Vector> {
    #[serde(with = "vector")]
    center: V,
    #[serde(with = "number")]
    radius: V::Scalar,
});

stored!(Aabb<V> = "named::Aabb", struct Aabb<V: Vector> {
    #[serde(with = "vector")]
    min: V,
    #[serde(with = "vector")]
    max: V,
});

stored!(Triangle<V> = "named::Triangle", struct Triangle<V: Vector> {
    #[serde(with = "vector")]
    v0: V,
    #[serde(with = "vector")]
    v1: V,
    #[serde(with = "vector")]
    v2: V,
});

stored!(Pyramid<V> = "named::Pyramid", struct Pyramid<V: Vector> {
    #[serde(with = "vector")]
    apex: V,
    #[serde(with = "vectors")]
    corners: [V; 4],
    #[serde(with = "vectors")]
    normals: [V; 4],
});

stored!(Cone<V> = "named::Cone", struct Cone<V: Vector> {
    ray: named::Ray<V>,
    #[serde(with = "number")]
    radius: V::Scalar,
    #[serde(with = "number")]
    spread: V::Scalar,
});

stored!(PlaneHit<T> = "named::PlaneHit", enum PlaneHit<T: Scalar> {
    #[serde(with = "number")]
    At(T),
    Contained,
});

stored!(SphereHit<T> = "named::SphereHit", struct SphereHit<T: Scalar> {
    #[serde(with = "number")]
    t: T,
    leaving: bool,
});

stored!(AabbHit<T> = "named::AabbHit", struct AabbHit<T: Scalar> {
    #[serde(with = "number")]
    t_enter: T,
    #[serde(with = "number")]
    t_exit: T,
    enter_face: Option<crate::Face>,
    exit_face: Option<crate::Face>,
});

stored!(TriangleHit<T> = "named::TriangleHit", struct TriangleHit<T: Scalar> {
    #[serde(with = "number")]
    t: T,
    #[serde(with = "number")]
    u: T,
    #[serde(with = "number")]
    v: T,
    front: bool,
});

stored!(PolygonHit<T> = "named::PolygonHit", struct PolygonHit<T: Scalar> {
    #[serde(with = "number")]
    t: T,
    triangle: usize,
    #[serde(with = "number")]
    u: T,
    #[serde(with = "number")]
    v: T,
    front: bool,
});

stored!(ConeHit<T> = "named::ConeHit", struct ConeHit<T: Scalar> {
    #[serde(with = "number")]
    t: T,
    #[serde(with = "number")]
    coverage: T,
});

impl<V: Vector<Scalar: Serialize>, const N: usize> Serialize for Polygon<V, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.vertices().iter().copied().map(Three))
    }
}

impl<'de, V: Vector<Scalar: Deserialize<'de>>, const N: usize> Deserialize<'de> for Polygon<V, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(PolygonVisitor(PhantomData))
    }
}

struct PolygonVisitor<V, const N: usize>(PhantomData<V>);

impl<'de, V: Vector<Scalar: Deserialize<'de>>, const N: usize> Visitor<'de>
    for PolygonVisitor<V, N>
{
    type Value = Polygon<V, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no more than {N} vertices")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Self::Value, A::Error> {
        let mut polygon = Polygon::EMPTY;
        while let Some(Three(vertex)) = sequence.next_element()? {
            polygon.push(vertex).ok_or_else(|| A::Error::invalid_length(N + 1, &self))?;
        }
        Ok(polygon)
    }
}

/// What is written of a beam, and read of it before it is one.
#[derive(Serialize, Deserialize)]
#[serde(
    rename = "Beam",
    bound(serialize = "V::Scalar: Serialize", deserialize = "V::Scalar: Deserialize<'de>")
)]
struct Unchecked<V: Vector, const N: usize> {
    #[serde(with = "vector")]
    apex: V,
    base: Polygon<V, N>,
}

impl<V: Vector<Scalar: Serialize>, const N: usize> Serialize for Beam<V, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { apex, base } = *self;
        Unchecked { apex, base }.serialize(serializer)
    }
}

impl<'de, V: Vector<Scalar: Deserialize<'de>>, const N: usize> Deserialize<'de> for Beam<V, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Unchecked { apex, base } = Deserialize::deserialize(deserializer)?;
        let refused = "a beam with an infinity or a NaN, a base without area, or the apex in the plane of its base";
        Self::new(apex, base).ok_or_else(|| D::Error::custom(refused))
    }
}
