// Patches of four-sided faces: bicubic, Gregory and bilinear. Included by limit.glsl.

// --- bicubic patches ------------------------------------------------------------------------------------------------

// Weights of four control points along a curve and their derivatives.
struct CurveWeights {
    vec4 w, d, dd;
};

// Uniform cubic B-spline.
CurveWeights splineWeights(float t) {
    float t2 = t * t, t3 = t2 * t, r = 1.0 - t;
    CurveWeights c;
    c.w = vec4(r * r * r, 4.0 - 6.0 * t2 + 3.0 * t3, 1.0 + 3.0 * (t + t2 - t3), t3) * (1.0 / 6.0);
    c.d = vec4(-0.5 * r * r, 1.5 * t2 - 2.0 * t, -1.5 * t2 + t + 0.5, 0.5 * t2);
    c.dd = vec4(r, 3.0 * t - 2.0, 1.0 - 3.0 * t, t);
    return c;
}

// Cubic Bernstein polynomials.
CurveWeights bezierWeights(float t) {
    float r = 1.0 - t;
    CurveWeights c;
    c.w = vec4(r * r * r, 3.0 * r * r * t, 3.0 * r * t * t, t * t * t);
    c.d = 3.0 * vec4(-r * r, r * (r - 2.0 * t), t * (2.0 * r - t), t * t);
    c.dd = 6.0 * vec4(r, t - 2.0 * r, r - 2.0 * t, t);
    return c;
}

// At a boundary the outer control point is a phantom: the reflection 2 a - b of the two beside it.
vec4 withoutFirst(vec4 w) { return vec4(0.0, w.y + 2.0 * w.x, w.z - w.x, w.w); }
vec4 withoutLast(vec4 w) { return vec4(w.x, w.y - w.w, w.z + 2.0 * w.w, 0.0); }

CurveWeights atBoundary(CurveWeights c, bool first, bool last) {
    if (first) c = CurveWeights(withoutFirst(c.w), withoutFirst(c.d), withoutFirst(c.dd));
    if (last) c = CurveWeights(withoutLast(c.w), withoutLast(c.d), withoutLast(c.dd));
    return c;
}

// Bits of a boundary: v = 0, u = 1, v = 1, u = 0.
void regularWeights(vec2 uv, uint boundary, out CurveWeights u, out CurveWeights v) {
    u = splineWeights(uv.x);
    v = splineWeights(uv.y);
    if (boundary != 0u) {
        u = atBoundary(u, (boundary & 8u) != 0u, (boundary & 2u) != 0u);
        v = atBoundary(v, (boundary & 1u) != 0u, (boundary & 4u) != 0u);
    }
}

// What a row of control points adds up to along u, by the point and two derivatives: from the patch's origin.
struct RowSums {
    vec3 x, xu, xuu;
};

RowSums sumRow(ControlPoints points, uint row, CurveWeights u, vec4 origin) {
    uvec4 i = RELIEF_POINT_ROW(points, row);
    vec3 a = RELIEF_OFFSET(points, i.x, origin), b = RELIEF_OFFSET(points, i.y, origin);
    vec3 c = RELIEF_OFFSET(points, i.z, origin), d = RELIEF_OFFSET(points, i.w, origin);
    precise vec3 x = u.w.x * a + u.w.y * b + u.w.z * c + u.w.w * d;
    precise vec3 xu = u.d.x * a + u.d.y * b + u.d.z * c + u.d.w * d;
    precise vec3 xuu = u.dd.x * a + u.dd.y * b + u.dd.z * c + u.dd.w * d;
    return RowSums(x, xu, xuu);
}

// Adds row `row` times its weights along v.
void addRow(inout LimitFrame f, RowSums sums, CurveWeights v, uint row) {
    precise vec3 p = f.p + v.w[row] * sums.x, pu = f.pu + v.w[row] * sums.xu, pv = f.pv + v.d[row] * sums.x;
    precise vec3 puu = f.puu + v.w[row] * sums.xuu, puv = f.puv + v.d[row] * sums.xu, pvv = f.pvv + v.dd[row] * sums.x;
    f = LimitFrame(p, pu, pv, puu, puv, pvv);
}

LimitFrame frameOfRows(RowSums rows[4], CurveWeights v, vec4 origin) {
    LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint row = 0u; row < 4u; ++row) addRow(f, rows[row], v, row);
    return fromOrigin(f, origin);
}

// Row by row, without an array of them: SwiftShader compiles arrays in loops for minutes.
LimitFrame regular(ControlPoints points, vec2 uv, vec4 origin) {
    CurveWeights u, v;
    regularWeights(uv, points.boundary, u, v);
    LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint row = 0u; row < 4u; ++row) addRow(f, sumRow(points, row, u, origin), v, row);
    return f;
}

LimitFrame bicubicFrame(ControlPoints points, vec2 uv) {
    vec4 origin = originOf(points);
    return fromOrigin(regular(points, uv, origin), origin);
}

// The frame of the texture coordinates on such a patch: two components, first derivatives; second ones only where the
// tangents of a vector map turn with them.
struct TexRowSums {
    vec2 x, xu, xuu;
};

TexRowSums sumTexRow(ControlPoints points, uint row, CurveWeights u) {
    uvec4 i = RELIEF_POINT_ROW(points, row);
    vec2 a = RELIEF_TEX_POINT(i.x), b = RELIEF_TEX_POINT(i.y), c = RELIEF_TEX_POINT(i.z), d = RELIEF_TEX_POINT(i.w);
    vec2 xuu = kVectorSpace == kVectorTangent ? u.dd.x * a + u.dd.y * b + u.dd.z * c + u.dd.w * d : vec2(0);
    return TexRowSums(u.w.x * a + u.w.y * b + u.w.z * c + u.w.w * d, u.d.x * a + u.d.y * b + u.d.z * c + u.d.w * d, xuu);
}

void addTexRow(inout LimitFrame f, TexRowSums sums, CurveWeights v, uint row) {
    f.p.xy += v.w[row] * sums.x;
    f.pu.xy += v.w[row] * sums.xu;
    f.pv.xy += v.d[row] * sums.x;
    if (kVectorSpace != kVectorTangent) return;
    f.puu.xy += v.w[row] * sums.xuu;
    f.puv.xy += v.d[row] * sums.xu;
    f.pvv.xy += v.dd[row] * sums.x;
}

LimitFrame texFrameOfRows(TexRowSums rows[4], CurveWeights v) {
    LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint row = 0u; row < 4u; ++row) addTexRow(f, rows[row], v, row);
    return f;
}

LimitFrame regularTexture(ControlPoints points, vec2 uv) {
    CurveWeights u, v;
    regularWeights(uv, points.boundary, u, v);
    LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint row = 0u; row < 4u; ++row) addTexRow(f, sumTexRow(points, row, u), v, row);
    return f;
}

// --- Gregory patches ------------------------------------------------------------------------------------------------

// Loop, Schaefer, Ni, Castano (2009): a bicubic Bezier patch whose four inner points F depend on (u,v), each a blend
// g a + (1 - g) b of two of the 20 control points with g = x / (x + y), where x and y are the distances to the sides
// at that corner. The derivatives are the true ones: product rule with those of F.
//
// Which control point each Bezier point is, by row, five bits each; inner ones name the first of their pair.
const uint kGregoryRows[4] = {0u | 1u << 5 | 7u << 10 | 5u << 15, 2u | 3u << 5 | 8u << 10 | 6u << 15,
                              16u | 18u << 5 | 13u << 10 | 12u << 15, 15u | 17u << 5 | 11u << 10 | 10u << 15};

LimitFrame gregory(ControlPoints points, vec2 uv, vec4 origin) {
    CurveWeights u = bezierWeights(uv.x), v = bezierWeights(uv.y);
    precise LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint k = 0u; k < 16u; ++k) {
        uint row = k >> 2, column = k & 3u;
        uint point = (kGregoryRows[row] >> (5u * column)) & 31u;
        vec3 c = controlPoint(points, point, origin);
        vec3 cu = vec3(0), cv = vec3(0), cuu = vec3(0), cuv = vec3(0), cvv = vec3(0);
        if ((row == 1u || row == 2u) && (column == 1u || column == 2u)) {
            // Distances from the corner's two sides and their derivatives: +1 at the near end, -1 at the far one.
            float du = column == 1u ? 1.0 : -1.0, dv = row == 1u ? 1.0 : -1.0;
            float x = column == 1u ? uv.x : 1.0 - uv.x, y = row == 1u ? uv.y : 1.0 - uv.y;
            bool isCorner = x + y <= 0.0;
            float inverse = isCorner ? 0.0 : 1.0 / (x + y);
            // The pair's first point goes with x at corners 0 and 2 (row and column alike), with y at corners 1 and 3.
            bool isX = row == column;
            float g = isCorner ? 0.5 : (isX ? x : y) * inverse;
            float gx = (isX ? y : -y) * inverse * inverse, gy = (isX ? -x : x) * inverse * inverse;
            float gxx = -2.0 * gx * inverse, gyy = -2.0 * gy * inverse;
            float gxy = (isX ? x - y : y - x) * inverse * inverse * inverse;
            vec3 other = controlPoint(points, point + 1u, origin);
            vec3 difference = c - other;
            c = other + g * difference;
            cu = gx * du * difference;
            cv = gy * dv * difference;
            cuu = gxx * difference;
            cuv = gxy * du * dv * difference;
            cvv = gyy * difference;
            // Near the corner u.w v.w is 9 x y to second order, so the difference of an isX pair has the weight
            // 9 x^2 y / (x + y). Its second derivatives in the corner depend on the direction of approach; along x = y they
            // are 9/4, 9/2 (mixed) and -9/4. g = 1/2 gives the mixed one below, the others are added here.
            float left = isCorner ? (isX ? 2.25 : -2.25) : 0.0;
            f.puu += left * difference;
            f.pvv -= left * difference;
        }
        float wu = u.w[column], wv = v.w[row], du = u.d[column], dv = v.d[row];
        f.p += wu * wv * c;
        f.pu += wv * (du * c + wu * cu);
        f.pv += wu * (dv * c + wv * cv);
        f.puu += wv * (u.dd[column] * c + 2.0 * du * cu + wu * cuu);
        f.puv += du * dv * c + du * wv * cv + wu * dv * cu + wu * wv * cuv;
        f.pvv += wu * (v.dd[row] * c + 2.0 * dv * cv + wv * cvv);
    }
    return f;
}

// --- bilinear patches -----------------------------------------------------------------------------------------------

LimitFrame bilinear(ControlPoints points, vec2 uv, vec4 origin) {
    vec3 a = controlPoint(points, 0u, origin), b = controlPoint(points, 1u, origin);
    vec3 c = controlPoint(points, 2u, origin), d = controlPoint(points, 3u, origin);
    LimitFrame f = kNoFrame;
    precise vec3 low = (1.0 - uv.x) * a + uv.x * b, high = (1.0 - uv.x) * d + uv.x * c;
    precise vec3 p = (1.0 - uv.y) * low + uv.y * high;
    f.p = p;
    f.pu = (1.0 - uv.y) * (b - a) + uv.y * (c - d);
    f.pv = high - low;
    f.puv = a - b + c - d;
    return f;
}
