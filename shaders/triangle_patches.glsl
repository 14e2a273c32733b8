// Patches of triangles. Included by limit.glsl.

// --- triangles, by OpenSubdiv's basis -------------------------------------------------------------------------------

// Weights of up to 18 control points for the point and its derivatives.
struct Weights {
    float p[18], du[18], dv[18], duu[18], duv[18], dvv[18];
};

LimitFrame weighted(Weights w, int count, ControlPoints points, vec4 origin) {
    precise LimitFrame f = kNoFrame;
    for (int i = 0; i < count; ++i) {
        vec3 c = controlPoint(points, uint(i), origin);
        f.p += w.p[i] * c;
        f.pu += w.du[i] * c;
        f.pv += w.dv[i] * c;
        f.puu += w.duu[i] * c;
        f.puv += w.duv[i] * c;
        f.pvv += w.dvv[i] * c;
    }
    return f;
}

// OpenSubdiv 3.5 differentiates a Gregory triangle as if its quotients were constant. Each interior Bezier weight B is
// shared by two points with the quotients r = a/(a+b) and 1 - r; the product rule adds B r' (and B' r' twice, B r'').
void addQuotientRule(inout Weights w, int first, float a, float b, vec2 da, vec2 db) {
    float sum = a + b;
    if (sum <= 0.0) {
        // In the corner itself second derivatives depend on the direction of approach: these are those of the weights
        // 12 a b a / (a + b) and 12 a b b / (a + b) along a = b.
        for (int i = 0; i < 2; ++i) {
            vec2 x = i == 0 ? da : db, y = i == 0 ? db : da;
            w.duu[first + i] = 3.0 * x.x * x.x + 12.0 * x.x * y.x - 3.0 * y.x * y.x;
            w.duv[first + i] = 3.0 * x.x * x.y + 6.0 * (x.x * y.y + x.y * y.x) - 3.0 * y.x * y.y;
            w.dvv[first + i] = 3.0 * x.y * x.y + 12.0 * x.y * y.y - 3.0 * y.y * y.y;
        }
        return;
    }
    vec2 dsum = da + db;
    vec2 dr = (da - dsum * (a / sum)) / sum;
    // r'' = -(r'_i sum_j + r'_j sum_i) / sum, for linear a and b.
    float ruu = -2.0 * dr.x * dsum.x / sum, rvv = -2.0 * dr.y * dsum.y / sum;
    float ruv = -(dr.x * dsum.y + dr.y * dsum.x) / sum;
    float B = w.p[first] + w.p[first + 1];
    vec2 dB = vec2(w.du[first] + w.du[first + 1], w.dv[first] + w.dv[first + 1]);
    for (int i = 0; i < 2; ++i) {
        float sign = i == 0 ? 1.0 : -1.0;
        w.du[first + i] += sign * B * dr.x;
        w.dv[first + i] += sign * B * dr.y;
        w.duu[first + i] += sign * (2.0 * dB.x * dr.x + B * ruu);
        w.duv[first + i] += sign * (dB.x * dr.y + dB.y * dr.x + B * ruv);
        w.dvv[first + i] += sign * (2.0 * dB.y * dr.y + B * rvv);
    }
}

LimitFrame trianglePatch(ControlPoints points, vec2 uv, vec4 origin) {
    Weights w;
    int count = 18;
    if (hasPatches(kPatchGregoryTriangle) && points.type == kPatchGregoryTriangle) {
        Osd_EvalBasisGregoryTri(uv.x, uv.y, w.p, w.du, w.dv, w.duu, w.duv, w.dvv);
        float u = uv.x, v = uv.y, t = 1.0 - u - v;
        addQuotientRule(w, 3, u, v, vec2(1, 0), vec2(0, 1));
        addQuotientRule(w, 8, v, t, vec2(0, 1), vec2(-1, -1));
        addQuotientRule(w, 13, t, u, vec2(-1, -1), vec2(1, 0));
    } else {
        float p[12], du[12], dv[12], duu[12], duv[12], dvv[12];
        count = 12;
        if (points.type == kPatchLoop) {
            Osd_EvalBasisBoxSplineTri(uv.x, uv.y, p, du, dv, duu, duv, dvv);
            if (points.boundary != 0u) Osd_boundBasisBoxSplineTri(int(points.boundary), p, du, dv, duu, duv, dvv);
        } else {
            count = 3;
            p[0] = 1.0 - uv.x - uv.y, p[1] = uv.x, p[2] = uv.y;
            du[0] = -1.0, du[1] = 1.0, du[2] = 0.0;
            dv[0] = -1.0, dv[1] = 0.0, dv[2] = 1.0;
            for (int i = 0; i < 3; ++i) duu[i] = duv[i] = dvv[i] = 0.0;
        }
        for (int i = 0; i < 12; ++i) {
            w.p[i] = p[i], w.du[i] = du[i], w.dv[i] = dv[i];
            w.duu[i] = duu[i], w.duv[i] = duv[i], w.dvv[i] = dvv[i];
        }
    }
    return weighted(w, count, points, origin);
}
